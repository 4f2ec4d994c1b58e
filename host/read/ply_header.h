// The header of a PLY file (Turk 1994): what elements the file holds, and which numbers each of them has.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace opal {

enum class PlyFormat { ascii, little_endian, big_endian };

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

// Calls `call` with a number of that type.
template <class Call> auto with_type(PlyType type, Call call) {
    switch (type) {
    case PlyType::int8:
        return call(int8_t());
    case PlyType::uint8:
        return call(uint8_t());
    case PlyType::int16:
        return call(int16_t());
    case PlyType::uint16:
        return call(uint16_t());
    case PlyType::int32:
        return call(int32_t());
    case PlyType::uint32:
        return call(uint32_t());
    case PlyType::int64:
        return call(int64_t());
    case PlyType::uint64:
        return call(uint64_t());
    case PlyType::float32:
        return call(float());
    default:
        return call(double());
    }
}

inline size_t size_of(PlyType type) {
    return with_type(type, [](auto number) { return sizeof number; });
}
inline bool is_integer(PlyType type) { return type < PlyType::float32; }
std::string_view name_of(PlyType type); // "float"

// A number of an element, or a list of numbers behind their count.
struct PlyProperty {
    std::string_view name; // in the file's text
    PlyType type;
    std::optional<PlyType> length_type; // of lists
    bool is_list() const { return length_type.has_value(); }
};

struct PlyElement {
    std::string_view name; // in the file's text, as are those of its properties
    uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements; // in the order of the file; each has a property, or a count of 0
    size_t end = 0;                   // offset of the first byte behind it
    int lines = 0;
};

// Throws Error "file:line:col: ...": a line that is no statement of a header, an unknown type or format, a property
// before the first element, or no end.
PlyHeader parse_ply_header(const std::filesystem::path &file, std::string_view text);

} // namespace opal
