#include "read/file_kind.h"

#include "base/command_line.h"
#include "base/error.h"
#include "base/read_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace opal {

namespace {

using namespace std::literals;

const std::string by_assimp = "convert it: assimp export FILE NEW.obj (Debian: assimp-utils), or import it into "
                              "Blender and export Wavefront (.obj)";
const std::string by_magick = "convert it: magick FILE NEW.png";
const std::string by_oiiotool = "convert it: oiiotool FILE -o NEW.exr";
const std::string by_blender = "open it in Blender and export Wavefront (.obj)";
const std::string no_text_format =
    "Opal reads scenes of Nori and Mitsuba (.xml), and Wavefront and PLY meshes (.obj, .ply)";
const std::string by_scene_for = "opal scene-for FILE > NEW.xml writes a scene around it";

// Kinds that begin with bytes of their own.
struct Magic {
    std::string_view bytes;
    std::string name, advice;
    FileKind kind = FileKind::other;
};
const std::vector<Magic> magics = {
    {"glTF", "a binary glTF scene", by_assimp},
    {"Kaydara FBX Binary", "an FBX scene", by_assimp},
    {"; FBX", "an FBX scene", by_assimp},
    {"BLENDER", "a Blender file", by_blender},
    {"OFF\n", "an OFF mesh", by_assimp},
    {"OFF\r", "an OFF mesh", by_assimp},
    {"#VRML", "a VRML scene", by_assimp},
    {"#usda", "a USD scene", by_blender},
    {"PXR-USDC", "a USD scene", by_blender},
    {"Ogawa", "an Alembic scene", by_blender},
    {"\x1c\x04"sv, "a Mitsuba .serialized mesh", "convert it: write_ply of Mitsuba 3, then assimp export FILE NEW.obj"},
    {"\x1f\x8b"sv, "compressed by gzip", "unpack it: gzip -dc FILE > NEW"},
    {"PK\x03\x04"sv, "a zip archive", "unpack it: unzip FILE"},
    {"BZh", "compressed by bzip2", "unpack it: bzip2 -dc FILE > NEW"},
    {"\xfd"
     "7zXZ",
     "compressed by xz", "unpack it: xz -dc FILE > NEW"},
    {"\x28\xb5\x2f\xfd", "compressed by zstd", "unpack it: zstd -dc FILE > NEW; if it is Blender's: " + by_blender},
    {"7z\xbc\xaf", "a 7z archive", "unpack it: 7z x FILE"},
    {"\x89PNG\r\n\x1a\n", "a PNG image", "", FileKind::png},
    {"\xff\xd8\xff", "a JPEG image", "", FileKind::jpeg},
    {"\x76\x2f\x31\x01", "an OpenEXR image", "", FileKind::exr},
    {"#?RADIANCE", "a Radiance HDR image", "", FileKind::hdr},
    {"#?RGBE", "a Radiance HDR image", "", FileKind::hdr},
    {"GIF8", "a GIF image", by_magick},
    {"II*\0"sv, "a TIFF image", by_oiiotool},
    {"MM\0*"sv, "a TIFF image", by_oiiotool},
    {"DDS ", "a DDS image", by_magick},
    {"\xabKTX ", "a KTX image", by_magick},
    {"PF\n", "a PFM image", by_oiiotool},
    {"Pf\n", "a PFM image", by_oiiotool},
    {"P5\n", "a PGM image", by_magick},
    {"P6\n", "a PPM image", by_magick},
    {"8BPS", "a Photoshop image", by_magick},
    {"\0\0\0\x0cjP  "sv, "a JPEG 2000 image", by_magick},
    {"\0\0\0\x0cJXL "sv, "a JPEG XL image", by_magick},
    {"\xff\x0a", "a JPEG XL image", by_magick},
    {"%PDF", "a PDF document", ""},
    {"version https://git-lfs", "a pointer that stands for the real file, by Git LFS", "get it: git lfs pull"},
};

// Its first line is "ply", and blanks may follow.
bool is_ply(std::string_view bytes) {
    if (!bytes.starts_with("ply"))
        return false;
    const size_t end = bytes.find_first_not_of(" \t", 3);
    return end != bytes.npos && (bytes[end] == '\n' || bytes[end] == '\r');
}

// A binary STL has no magic: its size follows from its count of triangles.
bool is_binary_stl(std::string_view bytes) {
    constexpr size_t header = 80, triangle = 50;
    uint32_t count = 0;
    if (bytes.size() < header + sizeof count)
        return false;
    std::memcpy(&count, bytes.data() + header, sizeof count);
    return count > 0 && bytes.size() == header + sizeof count + triangle * size_t(count);
}

// Images whose magic is not at their begin, or too short to tell them alone.
FileKindRow other_image(std::string_view bytes) {
    const auto has = [&](std::string_view part, size_t at) {
        return bytes.size() > at && bytes.substr(at).starts_with(part);
    };
    if (has("RIFF", 0) && has("WEBP", 8))
        return {FileKind::other, "a WebP image", by_magick};
    if (has("ftypavif", 4))
        return {FileKind::other, "an AVIF image", by_magick};
    if (has("ftyphei", 4) || has("ftypmif1", 4))
        return {FileKind::other, "a HEIF image", by_magick};
    if (has("BM", 0) && has("\0\0\0\0"sv, 6)) // reserved words
        return {FileKind::other, "a BMP image", by_magick};
    if (bytes.ends_with("TRUEVISION-XFILE.\0"sv))
        return {FileKind::other, "a TGA image", by_magick};
    return {};
}

std::string unicode_name(std::string_view bytes) {
    if (bytes.starts_with("\xff\xfe\0\0"sv) || bytes.starts_with("\0\0\xfe\xff"sv))
        return "UTF-32";
    if (bytes.starts_with("\xff\xfe"sv) || bytes.starts_with("\xfe\xff"sv))
        return "UTF-16";
    // Without a mark: text of ASCII letters has a zero in every second byte.
    const std::string_view start = bytes.substr(0, 64);
    std::array<size_t, 2> zeros{};
    for (size_t i = 0; i < start.size(); i++)
        zeros[i % 2] += start[i] == '\0';
    if (start.size() >= 4 && zeros[1] == start.size() / 2 && zeros[0] == 0)
        return "UTF-16LE";
    if (start.size() >= 4 && zeros[0] == start.size() / 2 && zeros[1] == 0)
        return "UTF-16BE";
    return "";
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view without_blanks(std::string_view text) {
    text.remove_prefix(size_t(std::find_if_not(text.begin(), text.end(), is_blank) - text.begin()));
    return text;
}

std::string_view first_word(std::string_view text) {
    return text.substr(0, size_t(std::find_if(text.begin(), text.end(), is_blank) - text.begin()));
}

bool contains(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

// The text from the '<' of the root element on; empty if there is none.
std::string_view xml_root(std::string_view text) {
    while (true) {
        text = without_blanks(text);
        std::string_view end;
        if (text.starts_with("<?"))
            end = "?>";
        else if (text.starts_with("<!--"))
            end = "-->";
        else if (text.starts_with("<!"))
            end = ">";
        else
            return text.starts_with("<") ? text : ""sv;
        const size_t at = text.find(end);
        if (at == text.npos)
            return "";
        text.remove_prefix(at + end.size());
    }
}

std::string without_comments(std::string_view text) {
    std::string result;
    for (size_t at = text.find("<!--"); at != text.npos; at = text.find("<!--")) {
        result += text.substr(0, at);
        text.remove_prefix(std::min(text.find("-->", at), text.size()));
    }
    return result.append(text);
}

// A version of three numbers in the tag: version="3.0.0".
bool has_long_version(std::string_view tag) {
    const size_t at = tag.find("version");
    if (at == tag.npos)
        return false;
    const size_t begin = tag.find_first_of("\"'", at);
    const std::string_view value =
        begin == tag.npos ? "" : tag.substr(begin + 1, tag.find(tag[begin], begin + 1) - begin - 1);
    return std::count(value.begin(), value.end(), '.') == 2;
}

// Nori's forks have some of Mitsuba's tags, and some scenes of Nori a version. A version as Mitsuba 3 writes it is
// Mitsuba's, unless there is a tag that Mitsuba does not have; a shorter one is, with tags that Nori does not have.
bool is_mitsuba(std::string_view root) {
    const std::string_view tag = root.substr(0, root.find('>'));
    const auto has = [&](std::initializer_list<std::string_view> tags) {
        return std::ranges::any_of(tags, [&](std::string_view each) { return contains(root, each); });
    };
    if (!contains(tag, "version") || has({"<camera", "<mesh"}))
        return false;
    return has_long_version(tag) || has({"<film", "<sensor", "<include", "<rgb", "<spectrum", "to_world"});
}

// The objects that may be the root of a file that a scene of Mitsuba includes.
constexpr std::string_view mitsuba_roots[] = {"bsdf",    "shape",   "emitter",   "sensor", "film",
                                              "sampler", "rfilter", "texture",   "medium", "spectrum",
                                              "volume",  "phase",   "integrator"};

FileKindRow kind_of_xml(std::string_view text) {
    const std::string_view root = xml_root(text);
    if (root.empty())
        return contains(text.substr(0, 1024), "<html") || contains(text.substr(0, 1024), "<HTML")
                   ? FileKindRow{FileKind::other, "a web page", "download the file itself ('Raw')"}
                   : FileKindRow{};
    const auto name_end =
        std::find_if(root.begin() + 1, root.end(), [](char c) { return is_blank(c) || c == '>' || c == '/'; });
    const std::string_view tag(root.data() + 1, size_t(name_end - root.begin()) - 1);
    const std::string_view root_tag = root.substr(0, root.find('>'));
    if (tag == "scene" ? is_mitsuba(without_comments(root))
                       : std::ranges::find(mitsuba_roots, tag) != std::end(mitsuba_roots) && has_long_version(root_tag))
        return {FileKind::mitsuba_scene, "a scene of Mitsuba", "render it: opal FILE"};
    if (tag == "scene" || tag == "test")
        return {FileKind::scene, "a scene", "render it: opal FILE"};
    if (tag == "COLLADA")
        return {FileKind::other, "a COLLADA scene", by_assimp};
    if (tag == "X3D")
        return {FileKind::other, "an X3D scene", by_assimp};
    if (tag == "amf")
        return {FileKind::other, "an AMF mesh", by_assimp};
    if (tag == "html" || tag == "HTML")
        return {FileKind::other, "a web page", "download the file itself ('Raw')"};
    if (tag == "svg")
        return {FileKind::other, "an SVG drawing", ""};
    return {}; // the XML's reader says which roots there are
}

// The first statement that is no comment; a '#' begins one.
std::string_view first_statement(std::string_view text) {
    for (text = without_blanks(text); text.starts_with("#"); text = without_blanks(text))
        text.remove_prefix(std::min(text.find('\n'), text.size()));
    return first_word(text);
}

FileKindRow kind_of_text(std::string_view text) {
    const std::string_view start = without_blanks(text.substr(0, 1 << 16));
    if (start.starts_with("<"))
        return kind_of_xml(text);
    if (start.starts_with("{"))
        return contains(text, "\"asset\"") && contains(text, "\"version\"")
                   ? FileKindRow{FileKind::other, "a glTF scene", by_assimp}
                   : FileKindRow{FileKind::text, "JSON", no_text_format};
    if (first_word(start) == "solid" && (contains(start, "facet") || contains(start, "endsolid")))
        return {FileKind::other, "an STL mesh", by_assimp};
    const std::string_view statement = first_statement(start);
    if (statement == "newmtl")
        return {FileKind::mtl, "a material library (MTL)", "the OBJ file names it by mtllib"};
    for (std::string_view own : {"v", "vn", "vt", "vp", "f", "o", "g", "s", "mtllib", "usemtl"})
        if (statement == own)
            return {FileKind::obj, "a Wavefront OBJ mesh", by_scene_for};
    for (std::string_view pbrt : {"LookAt", "WorldBegin", "Film", "Sampler", "Integrator", "Camera", "Scale"})
        if (statement == pbrt)
            return {FileKind::text, "a scene of PBRT", no_text_format};
    return {};
}

const char *name_of(FileKind wanted) {
    switch (wanted) {
    case FileKind::obj:
        return "an OBJ file";
    case FileKind::ply:
        return "a PLY file";
    case FileKind::mtl:
        return "a material library (MTL)";
    case FileKind::picture:
        return "an image that Opal reads (PNG, JPEG, Radiance HDR, OpenEXR)";
    default:
        return "a scene";
    }
}

// The advice with the file's name in it, as a shell takes it.
std::string advice_for(const std::filesystem::path &file, std::string advice) {
    const std::string placeholder = "FILE", name = shell_word(file.string());
    if (const size_t at = advice.find(placeholder); at != std::string::npos)
        advice.replace(at, placeholder.size(), name);
    return advice;
}

// An old Macintosh's line end; carriage returns before a line feed, or at the end of the file, are none.
size_t lone_carriage_return(std::string_view text) {
    for (size_t at = text.find('\r'); at != text.npos; at = text.find('\r', at)) {
        const size_t next = text.find_first_not_of('\r', at);
        if (next == text.npos)
            break;
        if (text[next] != '\n')
            return at;
        at = next;
    }
    return text.npos;
}

} // namespace

FileKindRow kind_of(std::string_view bytes) {
    if (const std::string unicode = unicode_name(bytes); !unicode.empty())
        return {FileKind::text, unicode + " text", fmt::format("convert it: iconv -f {} -t UTF-8 FILE > NEW", unicode)};
    if (bytes.starts_with("\xef\xbb\xbf"))
        bytes.remove_prefix(3);
    if (is_ply(bytes))
        return {FileKind::ply, "a PLY mesh", by_scene_for};
    for (const Magic &magic : magics)
        if (bytes.starts_with(magic.bytes))
            return {magic.kind, magic.name, magic.advice};
    if (const FileKindRow image = other_image(bytes); image.kind != FileKind::unknown)
        return image;
    if (is_binary_stl(bytes))
        return {FileKind::other, "a binary STL mesh", by_assimp};
    if (contains(bytes.substr(0, 4096), "\0"sv))
        return {FileKind::other, "a binary file", no_text_format};
    return kind_of_text(bytes);
}

std::string wrong_kind_text(const std::filesystem::path &file, const FileKindRow &found, FileKind wanted) {
    std::string advice = advice_for(file, found.advice);
    if (wanted == FileKind::obj && found.kind == FileKind::ply)
        advice = "its type in a scene is ply";
    else if (wanted == FileKind::ply && found.kind == FileKind::obj)
        advice = "its type in a scene is obj";
    else if (wanted == FileKind::picture && found.advice == no_text_format)
        advice = "";
    const bool is_other_scene = wanted == FileKind::scene && found.kind == FileKind::mitsuba_scene;
    return fmt::format("{}: is {}, not {}{}{}", file.string(),
                       found.name.empty() ? "a file of unknown kind" : found.name,
                       is_other_scene ? "one of Nori" : name_of(wanted), advice.empty() ? "" : "; ", advice);
}

std::string read_text_file(const std::filesystem::path &file, FileKind wanted, FileHashes *hashes) {
    const bool is_scene = wanted == FileKind::scene || wanted == FileKind::mitsuba_scene;
    std::string text = read_file(file, is_scene ? Pipes::read : Pipes::refused);
    if (hashes)
        hashes->add(text);
    const FileKindRow found = kind_of(text);
    // A reader of Mitsuba's scenes was chosen for the file, or for one that includes it.
    const bool fits = found.kind == wanted || (wanted == FileKind::mitsuba_scene && found.kind == FileKind::scene);
    if (found.kind != FileKind::unknown && !fits)
        throw Error(wrong_kind_text(file, found, wanted));
    if (text.starts_with("\xef\xbb\xbf"))
        text.erase(0, 3);
    if (lone_carriage_return(text) != text.npos)
        throw Error(fmt::format("{}: lines end with a carriage return alone, as on old Macintoshes; {}", file.string(),
                                advice_for(file, "convert them: tr '\\r' '\\n' < FILE > NEW")));
    return text;
}

} // namespace opal
