// PLY files in text and binary data, what Mitsuba makes of their meshes, then flatten.
#include "read/ply.h"
#include "base/error.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "fuzz/oracles.h"
#include "read/mitsuba/meshes.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace opal::fuzz {

namespace {

// The last byte says how the mesh is used.
void read(const ServedFile &file, unsigned char use) {
    const Transform to_world = use & 1 ? Transform::scale({1e3, -1, 1e-3}) : Transform();
    const std::vector<std::string> attributes = {"vertex_color", "vertex_w", "face_color"};
    TriangleMesh mesh = read_ply(file.path(), to_world, nullptr, attributes);
    check(mesh);
    if (use & 2)
        mesh = mitsuba::finished_mesh(
            std::move(mesh),
            {.face_normals = (use & 4) != 0, .flip_normals = (use & 8) != 0, .flip_tex_coords = (use & 16) != 0});
    check(mesh);
    SceneDescription scene;
    scene.meshes.emplace_back();
    if (!mesh.attributes.empty())
        scene.meshes[0].bsdf.textures[bsdf_parameters(BSDF_diffuse)[0].texture_word] =
            MeshAttributeTexture{.name = mesh.attributes[0]->name, .attribute = mesh.attributes[0]};
    scene.meshes[0].shape = std::move(mesh);
    if (use & 32)
        scene.meshes[0].radiance = Color{1, 1, 1};
    check(flatten(scene, use & 64 ? 16 : 1));
}

// Writes numbers of a format.
class Body {
public:
    Body(size_t format, Random &random) : format_(format), random_(random) {}

    template <class Number> void add(Number number) {
        if (format_ == 0) {
            text += std::to_string(number) + " ";
            return;
        }
        std::array<char, sizeof number> bytes;
        std::memcpy(bytes.data(), &number, sizeof number);
        if ((format_ == 1) != (std::endian::native == std::endian::little))
            std::reverse(bytes.begin(), bytes.end());
        text.append(bytes.data(), bytes.size());
    }
    void add_random() { add(float(below(7, random_)) - 2); }
    void end_element() {
        if (format_ == 0)
            text += '\n';
    }

    std::string text;

private:
    size_t format_;
    Random &random_;
};

// A file of few vertices, with faces of any size, their elements and properties in an order of chance.
std::string any_file(Random &random) {
    static const std::vector<std::string> formats = {"ascii", "binary_little_endian", "binary_big_endian"};
    const size_t format = below(formats.size(), random);
    std::string header = "ply\nformat " + formats[format] + " 1.0\ncomment c\n";
    Body body(format, random);
    const size_t vertex_count = 3 + below(8, random), face_count = 1 + below(6, random);
    const auto add_vertices = [&] {
        std::vector<std::string> properties = {"x", "y", "z"};
        for (const std::vector<std::string> &more : {std::vector<std::string>{"nx", "ny", "nz"}, {"s", "t"}, {"red"}})
            if (below(2, random) == 0)
                properties.insert(properties.end(), more.begin(), more.end());
        std::shuffle(properties.begin(), properties.end(), random);
        header += "element vertex " + std::to_string(vertex_count) + "\n";
        for (const std::string &property : properties)
            header += "property float " + property + "\n";
        for (size_t i = 0; i < vertex_count; i++) {
            for (size_t p = 0; p < properties.size(); p++)
                body.add_random();
            body.end_element();
        }
    };
    const auto add_faces = [&] {
        header += "element face " + std::to_string(face_count) + "\nproperty list uchar int vertex_indices\n" +
                  "property short flags\n";
        for (size_t i = 0; i < face_count; i++) {
            const size_t corners = 3 + (below(3, random) == 0 ? below(6, random) : 0);
            body.add(uint8_t(corners));
            for (size_t c = 0; c < corners; c++)
                body.add(int32_t(below(vertex_count, random)));
            body.add(int16_t(1));
            body.end_element();
        }
    };
    const auto add_edges = [&] {
        header += "element edge 1\nproperty list uint double w\n";
        body.add(uint32_t(1));
        body.add(0.5);
        body.end_element();
    };
    const bool faces_first = below(3, random) == 0;
    if (below(3, random) == 0)
        add_edges();
    if (faces_first)
        add_faces();
    add_vertices();
    if (!faces_first)
        add_faces();
    return header + "end_header\n" + body.text;
}

const TextFormat format = {.words = [](std::string_view text) { return separated(text, " \t\r\n"); },
                           .replacements = {"ascii",
                                            "binary_little_endian",
                                            "binary_big_endian",
                                            "element",
                                            "property",
                                            "list",
                                            "vertex",
                                            "face",
                                            "edge",
                                            "tristrips",
                                            "char",
                                            "uchar",
                                            "short",
                                            "ushort",
                                            "int",
                                            "uint",
                                            "float",
                                            "double",
                                            "int64",
                                            "uint64",
                                            "x",
                                            "y",
                                            "z",
                                            "nx",
                                            "ny",
                                            "nz",
                                            "s",
                                            "t",
                                            "u",
                                            "v",
                                            "red",
                                            "green",
                                            "blue",
                                            "w_0",
                                            "vertex_indices",
                                            "vertex_index",
                                            "comment",
                                            "obj_info",
                                            "end_header",
                                            "\r\n",
                                            "\n",
                                            "3 0 1 2"},
                           .start = any_file};

} // namespace

void try_input(std::string_view input) {
    static ServedFile file("mesh.ply");
    if (input.empty())
        return;
    file.write(input);
    try {
        read(file, static_cast<unsigned char>(input.back()));
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
