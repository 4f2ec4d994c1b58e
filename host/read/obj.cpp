#include "read/obj.h"

#include "base/error.h"
#include "base/large_vector.h"
#include "base/log.h"
#include "read/mesh_parts.h"
#include "read/obj_statements.h"
#include "read/triangulate.h"

#include <fmt/format.h>

#define TINYOBJLOADER_IMPLEMENTATION
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <unordered_map>

namespace opal {

namespace {

constexpr unsigned none = OPAL_NONE;

// Statements of OBJ that hold no surface, or say how to show one, which Opal decides otherwise.
constexpr std::string_view known_statements[] = {"vp",       "cstype",   "deg",   "bmat",  "step",       "parm",
                                                 "trim",     "hole",     "scrv",  "sp",    "end",        "con",
                                                 "s",        "mg",       "bevel", "lod",   "maplib",     "usemap",
                                                 "c_interp", "d_interp", "ctech", "stech", "shadow_obj", "trace_obj"};
constexpr std::string_view flat_statements[] = {"l", "p", "curv", "curv2", "surf"};

template <size_t Count> bool holds(const std::string_view (&list)[Count], std::string_view word) {
    return std::find(std::begin(list), std::end(list), word) != std::end(list);
}

// Reads the statements by tinyobjloader's callbacks. Where a face names an element that comes later in the file, or
// never, the faces are read again once all elements are known.
class ObjReader : public ObjStatements {
public:
    ObjReader(const std::filesystem::path &file, const Transform &to_world, FileHashes *hashes)
        : ObjStatements(file, hashes), file_(file.string()), to_world_(to_world) {}

    void read();
    ObjFile finish() &&;

private:
    struct FaceCorner {
        unsigned position, normal, uv;
    };
    // What faces and the statements between them make; indices count from 0.
    struct Faces {
        TriangleMesh mesh; // with indices of all elements of the file; its own are filled in by finish
        std::vector<ObjMaterialRun> runs;
        unsigned material = none;
        std::string object; // name of the present one
        ObjTally infinite;  // elements `vn` and `vt` that are not finite
        bool known = false; // some other statement of OBJ
        ObjTally unknown, not_surfaces;
        DroppedTriangles dropped;
    };

    static ObjReader &of(void *reader) { return *static_cast<ObjReader *>(reader); }
    void read_statements();
    void take_other() override;
    void use_material();
    void add_position();
    void add_normal();
    void add_uv();
    void add_face(const tinyobj::index_t *corners, size_t corner_count);
    FaceCorner read_corner(const tinyobj::index_t &written, std::string_view word);
    unsigned index_of(int written, size_t so_far, size_t all, const char *what, std::string_view word);
    std::vector<std::array<unsigned, 3>> cut(const std::vector<Vec3> &outline) const;
    void add_triangle(size_t a, size_t b, size_t c);
    void drop(double rounding);
    void tell(const TriangleMesh &mesh) const;

    std::string file_;
    Transform to_world_;
    LargeVector<Vec3> positions_, normals_; // in world space; normals unit, or zero where they are missing
    LargeVector<std::array<float, 2>> uvs_; // NaN where they are missing
    size_t positions_so_far_ = 0, normals_so_far_ = 0, uvs_so_far_ = 0;
    bool complete_ = false;    // all elements are known
    bool reads_again_ = false; // a face has named an element that is not
    std::vector<ObjMaterial> materials_;
    std::unordered_map<std::string, unsigned> material_index_;
    std::vector<ObjLibrary> libraries_;
    Faces faces_;

    std::vector<FaceCorner> corners_; // of the present face
    std::vector<Vec3> outline_;
};

void ObjReader::read() {
    read_statements();
    if (faces_.unknown.count > 0 && !faces_.known && positions_.empty() && normals_.empty() && uvs_.empty())
        throw Error(fmt::format("{}: is no OBJ file: it has no statement of one, but '{}'", faces_.unknown.place.text(),
                                faces_.unknown.word));
    complete_ = true;
    if (reads_again_)
        read_statements();
}

void ObjReader::read_statements() {
    rewind();
    faces_ = {};
    libraries_.clear();
    positions_so_far_ = normals_so_far_ = uvs_so_far_ = 0;
    tinyobj::callback_t callbacks;
    // The numbers are those of numbers().
    callbacks.vertex_cb = [](void *data, double, double, double, double) { of(data).add_position(); };
    callbacks.normal_cb = [](void *data, double, double, double) { of(data).add_normal(); };
    callbacks.texcoord_cb = [](void *data, double, double, double) { of(data).add_uv(); };
    callbacks.index_cb = [](void *data, tinyobj::index_t *corners, int count) {
        of(data).add_face(corners, size_t(count));
    };
    std::istream stream(this);
    stream.exceptions(std::ios::badbit); // so that an Error in the pass goes on
    tinyobj::LoadObjWithCallback(stream, callbacks, this);
}

void ObjReader::take_other() {
    const std::string_view kind = words()[0];
    if (kind == "o" || kind == "g") {
        faces_.object = rest();
    } else if (kind == "usemtl") {
        use_material();
    } else if (kind == "mtllib") {
        libraries_.push_back({rest(), place(kind)});
    } else if (kind == "f") {
        drop(0);
    } else if (holds(flat_statements, kind)) {
        count(faces_.not_surfaces, kind);
    } else if (!holds(known_statements, kind)) {
        count(faces_.unknown, kind);
        return;
    }
    faces_.known = true;
}

void ObjReader::use_material() {
    const auto [entry, is_new] = material_index_.try_emplace(rest(), unsigned(materials_.size()));
    if (is_new)
        materials_.push_back({entry->first, place(words()[0])});
    if (faces_.runs.empty() && !faces_.mesh.triangles.empty())
        faces_.runs.push_back({0, none});
    faces_.material = entry->second;
}

void ObjReader::add_position() {
    ++positions_so_far_;
    if (complete_)
        return;
    const auto [x, y, z] = numbers();
    const Vec3 p = to_world_.point({x, y, z});
    if (!fits_float(p))
        fail(words()[0],
             fmt::format("vertex {} is not finite in single precision once transformed", positions_so_far_));
    positions_.push_back(p);
}

void ObjReader::add_normal() {
    ++normals_so_far_;
    const auto [x, y, z] = numbers();
    if (!std::isfinite(x + y + z))
        count(faces_.infinite, words()[0]);
    if (complete_)
        return;
    normals_.push_back(unit_normal(to_world_, {x, y, z}));
}

void ObjReader::add_uv() {
    ++uvs_so_far_;
    const auto [u, v, ignored] = numbers();
    if (!std::isfinite(u + v))
        count(faces_.infinite, words()[0]);
    if (!complete_)
        uvs_.push_back({float(u), float(v)});
}

// written: counted from 1 or, where negative, backwards from the last element so far. all: elements known. The index
// may be too large.
unsigned ObjReader::index_of(int written, size_t so_far, size_t all, const char *what, std::string_view word) {
    const long long index = written > 0 ? written - 1LL : static_cast<long long>(so_far) + written;
    if (written == 0 || index < 0)
        fail(word, fmt::format("{} index {} is out of range: {} so far", what, written, so_far));
    reads_again_ |= size_t(index) >= all && !complete_;
    return unsigned(index);
}

ObjReader::FaceCorner ObjReader::read_corner(const tinyobj::index_t &written, std::string_view word) {
    FaceCorner corner{index_of(written.vertex_index, positions_so_far_, positions_.size(), "vertex", word), none, none};
    if (written.normal_index != 0)
        corner.normal = index_of(written.normal_index, normals_so_far_, normals_.size(), "normal", word);
    if (written.texcoord_index != 0)
        corner.uv = index_of(written.texcoord_index, uvs_so_far_, uvs_.size(), "texture", word);
    if (!complete_)
        return corner;
    if (corner.position >= positions_.size())
        fail(word, fmt::format("vertex index {} is out of range: the file has {}", corner.position + 1ull,
                               positions_.size()));
    for (auto [index, size] : {std::pair(&corner.normal, normals_.size()), std::pair(&corner.uv, uvs_.size())})
        if (*index != none && *index >= size) {
            count(absent, word);
            *index = none;
        }
    return corner;
}

void ObjReader::add_face(const tinyobj::index_t *corners, size_t corner_count) {
    if (reads_again_ && !complete_)
        return;
    corners_.clear();
    for (size_t i = 0; i < corner_count; ++i)
        corners_.push_back(read_corner(corners[i], words()[i + 1]));
    if (reads_again_ && !complete_) {
        faces_.mesh = {};
        return;
    }
    for (FaceCorner &corner : corners_) {
        if (corner.normal != none && dot(normals_[corner.normal], normals_[corner.normal]) == 0)
            corner.normal = none;
        if (corner.uv != none && !std::isfinite(uvs_[corner.uv][0] + uvs_[corner.uv][1]))
            corner.uv = none;
    }
    if (corner_count < 3) {
        drop(0);
    } else if (corner_count == 3) {
        add_triangle(0, 1, 2);
    } else {
        outline_.clear();
        for (const FaceCorner &corner : corners_)
            outline_.push_back(positions_[corner.position]);
        for (auto [a, b, c] : cut(outline_))
            add_triangle(a, b, c);
    }
}

// Triangles of the present face, whose corners these are.
std::vector<std::array<unsigned, 3>> ObjReader::cut(const std::vector<Vec3> &outline) const {
    try {
        return triangulate(outline);
    } catch (const Error &error) {
        fail(words()[0], error.what());
    }
}

// a, b, c: corners of the present face
void ObjReader::add_triangle(size_t a, size_t b, size_t c) {
    const std::array<FaceCorner, 3> corners = {corners_[a], corners_[b], corners_[c]};
    const std::array<Vec3, 3> p = {positions_[corners[0].position], positions_[corners[1].position],
                                   positions_[corners[2].position]};
    if (const double rounding = rounding_of(p); !has_area(p, rounding))
        return drop(rounding);
    TriangleMesh &mesh = faces_.mesh;
    if (!materials_.empty() && (faces_.runs.empty() || faces_.runs.back().material != faces_.material))
        faces_.runs.push_back({mesh.triangles.size(), faces_.material});
    const bool has_uv = corners[0].uv != none || corners[1].uv != none || corners[2].uv != none;
    if (has_uv && mesh.uv_corners.empty()) // those before have none
        mesh.uv_corners.resize(mesh.triangles.size(), {none, none, none});
    mesh.triangles.push_back({{{corners[0].position, corners[0].normal},
                               {corners[1].position, corners[1].normal},
                               {corners[2].position, corners[2].normal}}});
    if (has_uv || !mesh.uv_corners.empty())
        mesh.uv_corners.push_back({corners[0].uv, corners[1].uv, corners[2].uv});
}

// rounding: that of the triangle; 0 for a face of too few corners
void ObjReader::drop(double rounding) {
    DroppedTriangles &dropped = faces_.dropped;
    if (dropped.count++ == 0) {
        dropped.first_place = place(words()[0]).text();
        dropped.first_object = faces_.object;
    }
    dropped.rounding = std::max(dropped.rounding, rounding);
}

// Prints notes and warnings about the whole file.
void ObjReader::tell(const TriangleMesh &mesh) const {
    // print: note or warn
    const auto about = [](void (*print)(const std::string &), const ObjTally &tally, const std::string &text) {
        if (tally.count > 0)
            print(fmt::format("{}: {}{}", tally.place.text(), text,
                              tally.count == 1 ? "" : fmt::format(" ({} in the file)", tally.count)));
    };
    about(note, further_numbers, "further numbers of a vertex, a weight or a colour, are ignored");
    about(note, faces_.not_surfaces,
          fmt::format("statement '{}' is ignored: only faces are read as surfaces", faces_.not_surfaces.word));
    about(note, faces_.unknown, fmt::format("unknown statement '{}' is ignored", faces_.unknown.word));
    about(warn, absent, "no normal or texture coordinate has this index: the corner has none");
    about(warn, faces_.infinite, "a normal or texture coordinate is not finite: corners that name it have none");
    warn_of_dropped(file_, faces_.dropped, mesh);
}

ObjFile ObjReader::finish() && {
    using Corner = TriangleMesh::Corner;
    free_text();
    TriangleMesh mesh = std::move(faces_.mesh);
    mesh.positions = compact(positions_, mesh.triangles, [](Corner &corner) -> unsigned & { return corner.position; });
    free_memory(positions_);
    mesh.normals = compact(normals_, mesh.triangles, [](Corner &corner) -> unsigned & { return corner.normal; });
    free_memory(normals_);
    mesh.uvs = compact(uvs_, mesh.uv_corners, [](unsigned &index) -> unsigned & { return index; });
    tell(mesh);
    return {std::move(mesh), std::move(materials_), std::move(faces_.runs), std::move(libraries_)};
}

} // namespace

ObjFile read_obj(const std::filesystem::path &file, const Transform &to_world, FileHashes *hashes) {
    ObjReader reader(file, to_world, hashes);
    reader.read();
    return std::move(reader).finish();
}

} // namespace opal
