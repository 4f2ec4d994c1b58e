// The hash FNV-1a of 64 bits (Fowler, Noll and Vo), which is not safe against forgery.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace opal {

class Fnv1a {
public:
    void add(std::span<const std::byte> bytes) {
        for (std::byte byte : bytes)
            hash_ = (hash_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
    }
    std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

} // namespace opal
