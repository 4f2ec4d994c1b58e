// The hash XXH3 of 128 bits (Collet), by which files are told apart. It is not safe against forgery.
#pragma once

#include <string>
#include <string_view>

namespace opal {

std::string xxh128(std::string_view bytes); // 32 hexadecimal digits, as `xxh128sum` prints them

// The hashes of several files in their order, as one: xxh128 of their texts, a line each.
class FileHashes {
public:
    void add(std::string_view bytes) { lines_ += xxh128(bytes) + "\n"; }
    std::string value() const { return xxh128(lines_); }

private:
    std::string lines_;
};

} // namespace opal
