#include "read/obj.h"

#include "base/error.h"
#include "base/log.h"
#include "base/values.h"
#include "read/file_kind.h"
#include "read/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace opal {

namespace {

constexpr unsigned none = OPAL_NONE;

struct Face {
    size_t first, count; // range of its corners
    const char *statement;
};

// The contents of the file. Indices count from 0; `none`: not given.
struct Contents {
    std::string name;
    std::string_view text;
    const char *reading = nullptr; // the word at which an error happened
    std::vector<Vec3> positions, normals;
    size_t texture_count = 0;
    unsigned largest_texture = 0; // the largest texture index of a face, and its corner
    const char *largest_texture_corner = nullptr;
    std::vector<TriangleMesh::Corner> corners;
    std::vector<Face> faces;
    std::vector<ObjMaterial> materials;
    std::vector<std::pair<size_t, unsigned>> uses; // first face, material
    std::vector<ObjLibrary> libraries;
    size_t dropped = 0; // faces of fewer than three corners, triangles without area

    [[noreturn]] void fail(const char *word, const std::string &message) const {
        throw Error(place_in(name, text, word - text.data()).text() + ": " + message);
    }
};

// Statements of the text: lines without comments, joined where they end with a backslash.
class Statements {
public:
    explicit Statements(std::string_view text) : text_(text) {}

    bool next(std::vector<std::string_view> &words) {
        words.clear();
        while (words.empty() && position_ < text_.size()) {
            for (bool continued = true; continued;)
                continued = add_line(words);
        }
        return !words.empty();
    }

private:
    bool add_line(std::vector<std::string_view> &words) {
        size_t end = std::min(text_.find('\n', position_), text_.size());
        std::string_view row = text_.substr(position_, end - position_);
        position_ = end + 1;
        row = row.substr(0, row.find('#'));
        size_t last = row.find_last_not_of(" \t\r");
        bool continued = last != std::string_view::npos && row[last] == '\\' && position_ < text_.size();
        if (continued)
            row = row.substr(0, last);
        // find_first_of would call memchr for every character.
        const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
        for (auto start = std::find_if_not(row.begin(), row.end(), blank); start != row.end();) {
            const auto stop = std::find_if(start, row.end(), blank);
            words.emplace_back(start, stop);
            start = std::find_if_not(stop, row.end(), blank);
        }
        return continued;
    }

    std::string_view text_;
    size_t position_ = 0;
};

using Words = std::vector<std::string_view>;

// Further numbers on the line, such as vertex colours, are ignored.
Vec3 read_triple(Contents &obj, const Words &words) {
    if (words.size() < 4)
        throw Error("'" + std::string(words[0]) + "' needs three numbers");
    double numbers[3];
    for (size_t i = 0; i < 3; ++i) {
        obj.reading = words[i + 1].data();
        numbers[i] = parse_number(words[i + 1]);
    }
    return {numbers[0], numbers[1], numbers[2]};
}

// An index: counted from 1 or, where negative, backwards from the last element so far. Whether it is too large is known
// only at the end of the file.
unsigned read_index(std::string_view word, size_t count_so_far, const char *what) {
    int index = parse_integer(word);
    if (index == 0 || (index < 0 && size_t(-static_cast<long long>(index)) > count_so_far))
        throw Error(std::string(what) + " index " + std::string(word) +
                    " is out of range: " + std::to_string(count_so_far) + " so far");
    return index > 0 ? unsigned(index) - 1 : unsigned(static_cast<long long>(count_so_far) + index);
}

// v, v/vt, v//vn or v/vt/vn.
TriangleMesh::Corner read_corner(Contents &obj, std::string_view word) {
    obj.reading = word.data();
    std::string_view parts[3];
    size_t count = 0;
    for (std::string_view rest = word; count < 3; ++count) {
        size_t slash = std::min(rest.find('/'), rest.size());
        parts[count] = rest.substr(0, slash);
        if (slash == rest.size())
            break;
        rest.remove_prefix(slash + 1);
    }
    if (count == 3)
        throw Error("'" + std::string(word) + "' has more than vertex/texture/normal");
    if (!parts[1].empty())
        if (unsigned index = read_index(parts[1], obj.texture_count, "texture"); index >= obj.largest_texture) {
            obj.largest_texture = index;
            obj.largest_texture_corner = word.data();
        }
    return {read_index(parts[0], obj.positions.size(), "vertex"),
            parts[2].empty() ? none : read_index(parts[2], obj.normals.size(), "normal")};
}

void read_face(Contents &obj, const Words &words) {
    size_t first = obj.corners.size();
    for (size_t i = 1; i < words.size(); ++i)
        obj.corners.push_back(read_corner(obj, words[i]));
    obj.faces.push_back({first, words.size() - 1, words[0].data()});
}

std::string rest_of_line(const Words &words) { return {words[1].data(), words.back().data() + words.back().size()}; }

void use_material(Contents &obj, const Words &words) {
    const std::string name = rest_of_line(words);
    const auto known = std::find_if(obj.materials.begin(), obj.materials.end(),
                                    [&](const ObjMaterial &material) { return material.name == name; });
    obj.uses.push_back({obj.faces.size(), unsigned(known - obj.materials.begin())});
    if (known == obj.materials.end())
        obj.materials.push_back({name, place_in(obj.name, obj.text, obj.reading - obj.text.data())});
}

void read_statement(Contents &obj, const Words &words) {
    obj.reading = words[0].data();
    if (words[0] == "v")
        obj.positions.push_back(read_triple(obj, words));
    else if (words[0] == "vn")
        obj.normals.push_back(read_triple(obj, words));
    else if (words[0] == "vt")
        ++obj.texture_count;
    else if (words[0] == "f")
        read_face(obj, words);
    else if (words.size() > 1 && words[0] == "mtllib")
        obj.libraries.push_back({rest_of_line(words), place_in(obj.name, obj.text, obj.reading - obj.text.data())});
    else if (words.size() > 1 && words[0] == "usemtl")
        use_material(obj, words);
}

void read_statements(Contents &obj) {
    Statements statements(obj.text);
    for (Words words; statements.next(words);)
        try {
            read_statement(obj, words);
        } catch (const Error &error) {
            obj.fail(obj.reading, error.what());
        }
}

// Finds the word of a face's corner again, for an error message.
const char *corner_word(const Contents &obj, const Face &face, size_t corner) {
    Words words;
    Statements(obj.text.substr(size_t(face.statement - obj.text.data()))).next(words);
    return words[1 + corner - face.first].data();
}

std::string too_large(const char *what, unsigned index, size_t count) {
    return fmt::format("{} index {} is out of range: the file has {}", what, index + 1ull, count);
}

// Texture coordinates are not kept: Opal has no textures.
void check_indices(const Contents &obj) {
    for (const Face &face : obj.faces)
        for (size_t i = face.first; i < face.first + face.count; ++i) {
            const auto [position, normal] = obj.corners[i];
            if (position >= obj.positions.size())
                obj.fail(corner_word(obj, face, i), too_large("vertex", position, obj.positions.size()));
            if (normal != none && normal >= obj.normals.size())
                obj.fail(corner_word(obj, face, i), too_large("normal", normal, obj.normals.size()));
        }
    if (obj.largest_texture_corner && obj.largest_texture >= obj.texture_count)
        obj.fail(obj.largest_texture_corner, too_large("texture", obj.largest_texture, obj.texture_count));
}

// Replaces normals of length 0 by `none` in the corners.
void to_world_space(Contents &obj, const Transform &to_world) {
    for (Vec3 &p : obj.positions) {
        p = to_world.point(p);
        if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= std::numeric_limits<float>::max()))
            throw Error(obj.name + ": vertex " + std::to_string(&p - obj.positions.data() + 1) +
                        " is not finite in single precision once transformed");
    }
    for (Vec3 &n : obj.normals) {
        n = to_world.normal(n);
        double size = length(n);
        n = size > 0 && std::isfinite(size) ? n * (1 / size) : Vec3{};
    }
    for (TriangleMesh::Corner &corner : obj.corners)
        if (corner.normal != none && length(obj.normals[corner.normal]) == 0)
            corner.normal = none;
}

// A triangle has no area if its height over the longest edge may be due to rounding the coordinates to double.
bool has_area(const Contents &obj, const std::array<TriangleMesh::Corner, 3> &triangle) {
    Vec3 p[3];
    double largest = 0, longest2 = 0;
    for (int i = 0; i < 3; ++i) {
        p[i] = obj.positions[triangle[i].position];
        largest = std::max({largest, std::abs(p[i].x), std::abs(p[i].y), std::abs(p[i].z)});
    }
    for (int i = 0; i < 3; ++i)
        longest2 = std::max(longest2, dot(p[(i + 1) % 3] - p[i], p[(i + 1) % 3] - p[i]));
    const Vec3 doubled_area = cross(p[1] - p[0], p[2] - p[0]);
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * largest;
    return dot(doubled_area, doubled_area) >
           rounding * rounding * longest2; // no overflow: squares of floats fit into doubles
}

// Triangles of a face with these corners.
std::vector<std::array<unsigned, 3>> cut(const Contents &obj, const Face &face, const std::vector<Vec3> &outline) {
    try {
        return triangulate(outline);
    } catch (const Error &error) {
        obj.fail(face.statement, error.what());
    }
}

std::vector<std::array<TriangleMesh::Corner, 3>> make_triangles(Contents &obj, std::vector<ObjMaterialRun> &runs) {
    std::vector<std::array<TriangleMesh::Corner, 3>> triangles;
    std::vector<Vec3> outline;
    unsigned material = none;
    auto use = obj.uses.begin();
    for (const Face &face : obj.faces) {
        for (; use != obj.uses.end() && use->first <= size_t(&face - obj.faces.data()); ++use)
            material = use->second;
        const size_t first = triangles.size();
        const TriangleMesh::Corner *corner = &obj.corners[face.first];
        obj.dropped += face.count < 3;
        outline.clear();
        for (size_t i = 0; i < face.count; ++i)
            outline.push_back(obj.positions[corner[i].position]);
        for (auto [a, b, c] : cut(obj, face, outline)) {
            std::array<TriangleMesh::Corner, 3> triangle = {corner[a], corner[b], corner[c]};
            if (has_area(obj, triangle))
                triangles.push_back(triangle);
            else
                ++obj.dropped;
        }
        if (!obj.uses.empty() && triangles.size() > first && (runs.empty() || runs.back().material != material))
            runs.push_back({first, material});
    }
    return triangles;
}

// Keeps the entries that corners refer to by `member`, renumbered in the order of their first use.
std::vector<Vec3> compact(const std::vector<Vec3> &all, std::vector<std::array<TriangleMesh::Corner, 3>> &triangles,
                          unsigned TriangleMesh::Corner::*member) {
    std::vector<Vec3> used;
    std::vector<unsigned> renumbered(all.size(), none);
    for (auto &triangle : triangles)
        for (TriangleMesh::Corner &corner : triangle) {
            unsigned &index = corner.*member;
            if (index == none)
                continue;
            if (renumbered[index] == none) {
                renumbered[index] = unsigned(used.size());
                used.push_back(all[index]);
            }
            index = renumbered[index];
        }
    return used;
}

} // namespace

ObjFile read_obj(const std::filesystem::path &file, const Transform &to_world) {
    const std::string text = read_text_file(file, FileKind::obj);
    Contents obj;
    obj.name = file.string();
    obj.text = text;
    read_statements(obj);
    check_indices(obj);
    to_world_space(obj, to_world);
    ObjFile read;
    TriangleMesh &mesh = read.mesh;
    mesh.triangles = make_triangles(obj, read.material_runs);
    const std::string dropped = obj.dropped ? fmt::format("dropped {} triangles without area", obj.dropped) : "";
    if (mesh.triangles.empty())
        throw Error(obj.name + ": holds no triangles" + (obj.dropped ? ": " + dropped : ""));
    if (obj.dropped > 0)
        warn(fmt::format("{}: {}, kept {}", obj.name, dropped, mesh.triangles.size()));
    mesh.positions = compact(obj.positions, mesh.triangles, &TriangleMesh::Corner::position);
    mesh.normals = compact(obj.normals, mesh.triangles, &TriangleMesh::Corner::normal);
    read.materials = std::move(obj.materials);
    read.libraries = std::move(obj.libraries);
    return read;
}

} // namespace opal
