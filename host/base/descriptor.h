// File descriptors, and the calls on them that a signal may cut short.
#pragma once

#include <cerrno>
#include <string_view>
#include <utility>

#include <unistd.h>

namespace opal {

// A call that is made again if a signal ended it.
template <class Call> auto again(Call call) {
    auto result = call();
    while (result < 0 && errno == EINTR)
        result = call();
    return result;
}

// A descriptor that is closed at the latest when it goes out of scope; nothing where it is negative.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(Descriptor &&other) noexcept : number_(std::exchange(other.number_, -1)) {}
    ~Descriptor() { close(); }
    operator int() const { return number_; }
    // Returns errno, or 0. Linux has closed the file also where a signal came between.
    int close() { return number_ >= 0 && ::close(std::exchange(number_, -1)) != 0 && errno != EINTR ? errno : 0; }

private:
    int number_;
};

// Returns errno, or 0.
inline int write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = again([&] { return write(descriptor, bytes.data(), bytes.size()); });
        if (count < 0)
            return errno;
        bytes.remove_prefix(size_t(count));
    }
    return 0;
}

} // namespace opal
