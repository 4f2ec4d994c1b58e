// Files of Mitsuba's format: their trees of objects, whose properties are asked for by any name and type.
#include "base/error.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "read/mitsuba/object.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace opal::fuzz {

namespace {

using mitsuba::Object;
using mitsuba::SpectrumUse;

const std::vector<std::string> tags = {"scene",   "bsdf",    "shape",      "emitter", "sensor", "film",
                                       "sampler", "rfilter", "integrator", "texture", "medium", "spectrum"};
// Of the seed below, and of the dictionary.
const std::vector<std::string> names = {"radius", "to_world", "to_uv",     "reflectance", "radiance",
                                        "eta",    "a",        "max_depth", "flip",        "filename",
                                        "center", "nested",   "color",     "temperature", "p"};

void check(const std::optional<Color> &color) {
    for (double c : color.value_or(Color{}))
        require(std::isfinite(c), "colours are finite");
}

void check(const std::optional<Transform> &transform) {
    for (const auto &row : transform.value_or(Transform()).rows)
        require(std::ranges::all_of(row, [](double x) { return std::isfinite(x); }), "transforms are finite");
}

// Asks for everything, first by the type that `turn` chooses: a mistake in it leaves none for the others.
void visit(Object &object, size_t levels, unsigned turn, std::set<const Object *> &visited) {
    constexpr size_t most_levels = 64; // as object.h promises
    require(levels < most_levels, "few objects lie within each other");
    if (!visited.insert(&object).second)
        return;
    for (size_t i = 0; i < names.size(); i++) {
        const std::string &name = names[i];
        switch ((turn + i) % 9) {
        case 0:
            require(std::isfinite(object.number(name).value_or(0)), "numbers are finite");
            break;
        case 1:
            check(object.color(name, SpectrumUse::reflectance));
            break;
        case 2:
            check(object.color(name, SpectrumUse::radiance));
            break;
        case 3:
            check(object.color(name, SpectrumUse::index));
            break;
        case 4:
            check(object.transform(name));
            break;
        case 5:
            require(std::isfinite(length(object.point(name).value_or(Vec3{}))), "points are finite");
            break;
        case 6:
            object.integer(name);
            object.boolean(name);
            break;
        case 7:
            object.file(name);
            break;
        default:
            if (const auto child = object.child_named(name))
                require(object.has(name), "a child has a place");
        }
        object.place_of(name);
    }
    for (const std::string &tag : tags)
        for (const auto &child : object.children(tag))
            visit(*child, levels + 1, turn + unsigned(levels), visited);
    object.finish();
}

const std::string seed = R"(<scene version="3.0.0">
<default name="a" value="2"/>
<include filename="mesh.obj"/>
<bsdf type="twosided" id="m"><bsdf type="diffuse" name="nested">
<rgb name="reflectance" value="0.2, 0.3, 0.4"/></bsdf></bsdf>
<shape type="sphere" id="s"><float name="radius" value="$a"/><ref id="m"/><point name="center" x="0" y="1" z="2"/>
<transform name="to_world"><scale value="2"/><rotate x="1" angle="90"/><translate x="1"/>
<lookat origin="1 2 3" target="0 0 0" up="0 1 0"/><matrix value="1 0 0 0 1 0 0 0 1"/></transform>
<emitter type="area"><spectrum name="radiance" value="400:0.1, 500:2, 700:1"/></emitter></shape>
<alias id="m" as="n"/><path value="."/>
<texture type="bitmap" id="t"><string name="filename" value="scene.xml"/><float name="uscale" value="3"/></texture>
<shape type="rectangle"><ref id="n" name="p"/><boolean name="flip" value="true"/>
<emitter type="area"><spectrum name="radiance" type="d65"><rgb name="color" value="1"/></spectrum></emitter></shape>
<emitter type="point"><spectrum name="radiance" type="blackbody"><float name="temperature" value="5000"/></spectrum>
</emitter><integrator type="path"><integer name="max_depth" value="$a"/></integrator>
</scene>
)";

const TextFormat format = {.words = quoted,
                           .replacements = {"0 0 0",
                                            "1 1 1",
                                            "1e38 1e38 1e38",
                                            "400:1 500:2",
                                            "500:1e38,501:-1e38",
                                            "#ff8000",
                                            "0.6.0",
                                            "3.0.0",
                                            "$a",
                                            "$ab",
                                            "\\$a",
                                            "$",
                                            "true",
                                            "scene.xml",
                                            "mesh.obj",
                                            "m",
                                            "n",
                                            "s",
                                            "t",
                                            "nested",
                                            "reflectance",
                                            "radius",
                                            "diffuseReflectance",
                                            "uscale",
                                            "d65",
                                            "blackbody",
                                            "uniform",
                                            "srgb"},
                           .piece = '<',
                           .start = [](Random &) { return seed; }};

} // namespace

// The last byte says how the input is read. Behind a line `#include` it is the file that <include> names.
void try_input(std::string_view input) {
    constexpr std::string_view marker = "#include\n";
    static ServedFile main("scene.xml"), included("mesh.obj");
    if (input.empty())
        return;
    const auto use = static_cast<unsigned char>(input.back());
    const size_t end = input.find(marker);
    main.write(input.substr(0, end));
    included.write(end == input.npos ? "<scene version=\"0.6.0\"/>" : input.substr(end + marker.size()));
    Mistakes mistakes;
    FileHashes hashes;
    const ParseContext context{
        .folder = main.path().parent_path(), .lenient = (use & 1) != 0, .mistakes = &mistakes, .hashes = &hashes};
    try {
        const Definitions definitions = use & 64 ? Definitions{{"a", "7"}} : Definitions{};
        const mitsuba::MitsubaScene scene = mitsuba::read_document(main.path(), definitions, context);
        std::set<const Object *> visited;
        visit(*scene.root, 0, use, visited);
        mistakes.throw_all();
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
