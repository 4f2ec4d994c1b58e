#include "read/ply.h"

#include "base/error.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/printable.h"
#include "base/read_file.h"
#include "read/file_kind.h"
#include "read/mesh_parts.h"
#include "read/ply_header.h"
#include "read/triangulate.h"
#include "read/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace opal {

namespace {

constexpr unsigned none = OPAL_NONE;

// What is read of a vertex; `field_other` takes numbers that are not used. Those of attributes follow: field_count + i.
enum Field { field_x, field_y, field_z, field_nx, field_ny, field_nz, field_u, field_v, field_other, field_count };
constexpr std::string_view position_names[] = {"x", "y", "z"}, normal_names[] = {"nx", "ny", "nz"};
constexpr std::string_view uv_names[][2] = {{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}};
constexpr std::string_view corner_names[] = {"vertex_indices", "vertex_index"};

float as_float(double number) { return std::abs(number) <= std::numeric_limits<float>::max() ? float(number) : NAN; }

// A place in the body, from which reading can go on.
struct BodyPosition {
    size_t next;   // the first byte that is not read
    size_t start;  // of the present element or, in text, of its line
    int lines = 0; // of the file up to that of `start`, in text
};

// Numbers in text: an element a line. begin and end enclose an element. Errors are given to `fail` with an offset.
template <class Fail> class TextNumbers {
public:
    TextNumbers(std::string_view text, BodyPosition &at, const Fail &fail) : text_(text), at_(at), fail_(fail) {}

    static constexpr size_t least_bytes(PlyType) { return 2; } // a digit and a blank or line end
    static constexpr size_t bytes_in_excess = 1;               // the last line may have no end

    void begin() {
        do {
            at_.start = at_.next;
            ++at_.lines;
            if (at_.start >= text_.size())
                fail_(text_.size(), "the file ends before this element");
            end_ = std::min(text_.find('\n', at_.start), text_.size());
            at_.next = std::min(end_ + 1, text_.size());
            place_ = at_.start;
        } while (word().empty());
        place_ = at_.start;
    }
    void end() {
        if (const std::string_view more = word(); !more.empty())
            fail_(more, quoted(more) + " is more than the element has properties");
    }
    void finish() {
        while (at_.next < text_.size() && (is_blank(text_[at_.next]) || text_[at_.next] == '\n')) {
            at_.lines += text_[at_.next] == '\n';
            ++at_.next;
        }
    }

    double number(const PlyProperty &property, PlyType type) {
        const std::string_view text = word();
        if (text.empty())
            fail_(end_, fmt::format("the line ends, but a number of {} is expected", quoted(property.name)));
        if (!is_integer(type)) // in double, whatever it is called
            return parse(text, double());
        return with_type(type, [&]<class Number>(Number number) { return parse(text, number); });
    }
    void check_room(const PlyProperty &, double, PlyType) {} // each number is missed where it should be

private:
    std::string_view text_;
    BodyPosition &at_;
    const Fail &fail_;
    size_t end_ = 0, place_ = 0; // of the line, and of the next word or blank in it

    static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

    std::string_view word() {
        while (place_ < end_ && is_blank(text_[place_]))
            ++place_;
        const size_t first = place_;
        while (place_ < end_ && !is_blank(text_[place_]))
            ++place_;
        return text_.substr(first, place_ - first);
    }

    template <class Number> double parse(std::string_view word, Number number) const {
        std::string_view digits = word;
        if (digits.starts_with('+') && !digits.starts_with("+-"))
            digits.remove_prefix(1);
        const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
        if (error == std::errc() && stop == digits.data() + digits.size())
            return double(number);
        if constexpr (std::is_integral_v<Number>) {
            int64_t any;
            const auto [all, other_error] = std::from_chars(digits.data(), digits.data() + digits.size(), any);
            const bool is_whole = all == digits.data() + digits.size() && other_error != std::errc::invalid_argument;
            fail_(word, quoted(word) + (is_whole ? " is out of the range of its type" : " is no whole number"));
        }
        try {
            return parse_coordinate_or_nan(word);
        } catch (const Error &mistake) {
            fail_(word, mistake.what());
        }
    }
};

// Numbers in binary data.
template <std::endian Order, class Fail> class BinaryNumbers {
public:
    BinaryNumbers(std::string_view text, BodyPosition &at, const Fail &fail) : text_(text), at_(at), fail_(fail) {}

    static constexpr size_t least_bytes(PlyType type) { return size_of(type); }
    static constexpr size_t bytes_in_excess = 0;

    void begin() { at_.start = at_.next; }
    void end() {}
    void finish() {}

    double number(const PlyProperty &property, PlyType type) {
        return with_type(type, [&]<class Number>(Number number) {
            if (text_.size() - at_.next < sizeof number)
                fail_(at_.next, fmt::format("the file ends within {}", quoted(property.name)));
            std::array<char, sizeof number> bytes;
            std::memcpy(bytes.data(), text_.data() + at_.next, sizeof number);
            if constexpr (Order != std::endian::native)
                std::reverse(bytes.begin(), bytes.end());
            at_.next += sizeof number;
            return double(std::bit_cast<Number>(bytes));
        });
    }
    void check_room(const PlyProperty &property, double count, PlyType type) {
        if (const size_t left = text_.size() - at_.next; count * double(size_of(type)) > double(left))
            fail_(at_.next, fmt::format("{} has {:.0f} numbers, but {} bytes are left of the file",
                                        quoted(property.name), count, left));
    }

private:
    std::string_view text_;
    BodyPosition &at_;
    const Fail &fail_;
};

// An attribute that is asked for; its numbers come from the fields from first_field on.
struct AttributeReading {
    MeshAttribute made;
    size_t first_field;
    size_t infinite = 0;     // numbers that are not finite
    std::string first_place; // in the header
};

// The properties that may make an attribute: three numbers, or the first alone if it has a suffix. name: without
// `vertex_` or `face_`.
std::vector<std::array<std::string, 3>> attribute_properties(const std::string &name) {
    std::vector<std::array<std::string, 3>> all;
    if (name == "color")
        all = {{"red", "green", "blue"}, {"r", "g", "b"}};
    for (const char *ends : {"xyz", "012", "123"})
        all.push_back({name + '_' + ends[0], name + '_' + ends[1], name + '_' + ends[2]});
    if (const std::string_view end = "_color"; name.ends_with(end)) {
        const std::string stem = name.substr(0, name.size() - end.size());
        all.push_back({stem + "_r", stem + "_g", stem + "_b"});
    }
    return all;
}

// Keeps the values of these vertices, in that order.
void keep_values_of(const LargeVector<unsigned> &vertices, MeshAttribute &attribute) {
    const auto channels = size_t(attribute.channels);
    LargeVector<float> kept;
    kept.reserve(channels * vertices.size());
    for (unsigned vertex : vertices)
        for (size_t channel = 0; channel < channels; ++channel)
            kept.push_back(attribute.values[channels * vertex + channel]);
    attribute.values = std::move(kept);
}

class PlyReader {
public:
    PlyReader(const std::filesystem::path &file, const Transform &to_world, FileHashes *hashes)
        : file_(file.string()), to_world_(to_world), is_mirrored_(to_world.determinant() < 0),
          text_(read_file(file, Pipes::refused)) {
        if (hashes)
            hashes->add(text_);
        const FileKindRow found = kind_of(text_);
        if (found.kind != FileKind::unknown && found.kind != FileKind::ply)
            throw Error(wrong_kind_text(file, found, FileKind::ply));
        header_ = parse_ply_header(file, text_);
        at_ = {header_.end, header_.end, header_.lines};
        dropped_ = header_.end;
    }

    TriangleMesh read(std::span<const std::string> attributes) &&;

private:
    // Reports a mistake: `where` is an offset in the file, or a word of it.
    struct Fail {
        const PlyReader &reader;
        [[noreturn]] void operator()(size_t offset, const std::string &message) const {
            throw Error(reader.place(offset) + ": " + message);
        }
        [[noreturn]] void operator()(std::string_view word, const std::string &message) const {
            (*this)(size_t(word.data() - reader.text_.data()), message);
        }
    };

    std::string file_;
    Transform to_world_;
    bool is_mirrored_;
    std::string text_;
    PlyHeader header_;
    BodyPosition at_{};
    const PlyElement *element_ = nullptr; // the present one, and its number
    uint64_t number_ = 0;
    size_t dropped_ = 0; // offset up to which the text's pages are dropped
    bool may_drop_ = true;
    const Fail fail_{*this};

    const PlyElement *vertex_ = nullptr, *face_ = nullptr;
    std::vector<size_t> vertex_fields_; // of each property of `vertex`, a Field
    bool has_normals_ = false, has_uvs_ = false;
    const PlyProperty *corner_list_ = nullptr;
    std::vector<size_t> face_fields_; // of each property of `face`: field_other, or field_count + i
    std::vector<double> fields_;      // of the present vertex or face
    std::vector<AttributeReading> vertex_attributes_, face_attributes_;

    TriangleMesh mesh_; // until finish with indices of vertices of the file, for normals and uv, too
    DroppedTriangles dropped_triangles_;
    size_t infinite_ = 0; // vertices whose normal or uv is not finite
    std::string first_infinite_;
    size_t front_ = 0, back_ = 0;   // triangles whose normals are on the front and on the back
    std::vector<unsigned> corners_; // of the present face
    std::vector<Vec3> outline_;

    std::string place(size_t offset) const;
    std::string place_in_header(std::string_view word) const;
    [[noreturn]] void fail_in_header(std::string_view word, const std::string &message) const;
    const PlyElement *find_element(std::string_view name) const;
    void find_properties();
    template <size_t Count> bool take_fields(const std::string_view (&names)[Count], Field first);
    void find_attribute(const std::string &wanted);
    bool is_skipped(const PlyElement &element, size_t property) const;
    void note_what_is_skipped() const;

    template <class Numbers> void read_body(Numbers numbers);
    template <class Numbers> void check_room(const PlyElement &element) const;
    template <class Numbers, class Take> void read_elements(const PlyElement &element, Numbers &numbers, Take take);
    template <class Numbers> void skip(const PlyProperty &property, Numbers &numbers);
    template <class Numbers> double take_length(const PlyProperty &property, Numbers &numbers);
    template <class Numbers> void read_vertices(Numbers &numbers);
    template <class Numbers> void read_faces(Numbers &numbers);
    void add_vertex();
    void add_values(std::vector<AttributeReading> &attributes);
    void add_face();
    void add_triangle(unsigned a, unsigned b, unsigned c);
    void drop(double rounding);
    void drop_text();
    TriangleMesh finish();
};

std::string PlyReader::place(size_t offset) const {
    if (header_.format != PlyFormat::ascii) {
        const std::string element = element_ ? fmt::format(" ({} {})", element_->name, number_) : "";
        return fmt::format("{}: byte {}{}", file_, offset, element);
    }
    SourcePlace place = place_in(file_, std::string_view(text_).substr(at_.start), ptrdiff_t(offset - at_.start));
    place.line = at_.lines;
    return place.text();
}

std::string PlyReader::place_in_header(std::string_view word) const {
    return place_in(file_, text_, word.data() - text_.data()).text();
}

void PlyReader::fail_in_header(std::string_view word, const std::string &message) const {
    throw Error(place_in_header(word) + ": " + message);
}

const PlyElement *PlyReader::find_element(std::string_view name) const {
    const PlyElement *found = nullptr;
    for (const PlyElement &element : header_.elements)
        if (element.name == name) {
            if (found)
                fail_in_header(element.name, fmt::format("element '{}' again", name));
            found = &element;
        }
    return found;
}

// Takes properties of `vertex` as fields, if it has them all.
template <size_t Count> bool PlyReader::take_fields(const std::string_view (&names)[Count], Field first) {
    std::array<size_t, Count> found{};
    for (size_t name = 0; name < Count; ++name) {
        const auto is_it = [&](const PlyProperty &property) {
            return property.name == names[name] && !property.is_list();
        };
        const auto &all = vertex_->properties;
        const auto it = std::find_if(all.begin(), all.end(), is_it);
        if (it == all.end())
            return false;
        if (const auto again = std::find_if(it + 1, all.end(), is_it); again != all.end())
            fail_in_header(again->name, fmt::format("property '{}' again", names[name]));
        found[name] = size_t(it - all.begin());
    }
    for (size_t name = 0; name < Count; ++name)
        vertex_fields_[found[name]] = first + name;
    return true;
}

void PlyReader::find_properties() {
    vertex_ = find_element("vertex");
    face_ = find_element("face");
    if (!vertex_)
        throw Error(file_ + ": has no element 'vertex'");
    if (vertex_->count >= none)
        fail_in_header(vertex_->name, fmt::format("{} vertices are too many: at most {}", vertex_->count, none - 1));
    fields_.assign(field_count, 0);
    vertex_fields_.assign(vertex_->properties.size(), field_other);
    face_fields_.assign(face_ ? face_->properties.size() : 0, field_other);
    if (vertex_->count > 0 && !take_fields(position_names, field_x))
        fail_in_header(vertex_->name, "element 'vertex' needs the properties x, y and z");
    has_normals_ = take_fields(normal_names, field_nx);
    for (const auto &names : uv_names)
        has_uvs_ = has_uvs_ || take_fields(names, field_u);
    if (const PlyElement *strips = find_element("tristrips"); strips && strips->count > 0)
        fail_in_header(strips->name, "triangle strips are not read; open the file in Blender and export it again");
    if (!face_ || face_->count == 0)
        return;
    for (const PlyProperty &property : face_->properties)
        if (std::find(std::begin(corner_names), std::end(corner_names), property.name) != std::end(corner_names)) {
            if (corner_list_)
                fail_in_header(property.name, fmt::format("a second list of corners, '{}'", property.name));
            if (!property.is_list() || !is_integer(property.type))
                fail_in_header(property.name, fmt::format("'{}' is no list of whole numbers", property.name));
            corner_list_ = &property;
        }
    if (!corner_list_)
        fail_in_header(face_->name, "element 'face' needs the list vertex_indices or vertex_index");
}

// Adds an attribute of that name, as vertex_color, if the file has one.
void PlyReader::find_attribute(const std::string &wanted) {
    const bool of_faces = wanted.starts_with("face_");
    const PlyElement *const element = of_faces ? face_ : vertex_;
    if (!element)
        return;
    std::vector<size_t> &fields = of_faces ? face_fields_ : vertex_fields_;
    std::vector<AttributeReading> &attributes = of_faces ? face_attributes_ : vertex_attributes_;
    const auto find = [&](const std::string &name) {
        const auto &all = element->properties;
        return size_t(std::ranges::find_if(all, [&](const PlyProperty &p) { return p.name == name && !p.is_list(); }) -
                      all.begin());
    };
    const std::string name = wanted.substr(wanted.find('_') + 1);
    for (const auto &names : attribute_properties(name)) {
        const std::array<size_t, 3> found = {find(names[0]), find(names[1]), find(names[2])};
        const size_t count =
            size_t(std::ranges::count_if(found, [&](size_t i) { return i < element->properties.size(); }));
        if (found[0] == element->properties.size() || count == 2 ||
            (count == 1 && names[0].find('_') == std::string::npos))
            continue;
        AttributeReading &reading = attributes.emplace_back();
        reading.made.name = wanted;
        reading.made.channels = int(count);
        reading.made.of_faces = of_faces;
        reading.first_field = fields_.size();
        reading.first_place = place_in_header(element->properties[found[0]].name);
        for (size_t channel = 0; channel < count; ++channel)
            fields[found[channel]] = fields_.size() + channel;
        fields_.resize(fields_.size() + count);
        if (is_integer(element->properties[found[0]].type))
            warn(fmt::format("{}: the attribute {} has whole numbers, which are taken as they stand: 255 is no 1, and "
                             "they are linear",
                             reading.first_place, wanted));
        return;
    }
}

bool PlyReader::is_skipped(const PlyElement &element, size_t property) const {
    return (&element == vertex_ && vertex_fields_[property] == field_other) ||
           (&element == face_ && &element.properties[property] != corner_list_ &&
            face_fields_[property] == field_other);
}

// One note, which names the first few.
void PlyReader::note_what_is_skipped() const {
    constexpr size_t most_names = 12;
    std::vector<std::string> names;
    std::string_view first;
    const auto skipped = [&](std::string_view word, const std::string &name) {
        if (names.empty())
            first = word;
        if (names.size() <= most_names)
            names.push_back(names.size() < most_names ? name : "...");
    };
    for (const PlyElement &element : header_.elements) {
        if (element.count == 0)
            continue;
        if (&element != vertex_ && &element != face_)
            skipped(element.name, fmt::format("element {}", quoted(element.name)));
        for (size_t i = 0; i < element.properties.size(); ++i) {
            const PlyProperty &property = element.properties[i];
            if (is_skipped(element, i))
                skipped(property.name, fmt::format("{} of {}", quoted(property.name), element.name));
        }
    }
    if (!names.empty())
        note(fmt::format("{}: not used: {}", place_in_header(first), fmt::join(names, ", ")));
}

TriangleMesh PlyReader::read(std::span<const std::string> attributes) && {
    find_properties();
    for (const std::string &attribute : attributes)
        find_attribute(attribute);
    switch (header_.format) {
    case PlyFormat::ascii:
        read_body(TextNumbers<Fail>(text_, at_, fail_));
        break;
    case PlyFormat::little_endian:
        read_body(BinaryNumbers<std::endian::little, Fail>(text_, at_, fail_));
        break;
    case PlyFormat::big_endian:
        read_body(BinaryNumbers<std::endian::big, Fail>(text_, at_, fail_));
    }
    note_what_is_skipped();
    return finish();
}

template <class Numbers> void PlyReader::read_body(Numbers numbers) {
    const bool faces_first = face_ && face_ < vertex_;
    may_drop_ = !faces_first;
    BodyPosition faces{};
    for (const PlyElement &element : header_.elements) {
        element_ = &element;
        number_ = 0;
        check_room<Numbers>(element);
        if (&element == vertex_) {
            read_vertices(numbers);
        } else if (&element == face_ && !faces_first) {
            read_faces(numbers);
        } else {
            if (&element == face_)
                faces = at_;
            read_elements(element, numbers, [&] {
                for (const PlyProperty &property : element.properties)
                    skip(property, numbers);
            });
        }
    }
    numbers.finish();
    element_ = nullptr;
    if (at_.next < text_.size()) {
        at_.start = at_.next;
        ++at_.lines;
        fail_(at_.next, fmt::format("{} bytes are left behind the last element", text_.size() - at_.next));
    }
    if (faces_first) {
        element_ = face_;
        at_ = faces;
        read_faces(numbers);
    }
}

// So that a count beyond the file's size takes neither memory nor time.
template <class Numbers> void PlyReader::check_room(const PlyElement &element) const {
    if (element.count == 0)
        return;
    size_t least = 0;
    for (const PlyProperty &property : element.properties)
        least += Numbers::least_bytes(property.length_type.value_or(property.type));
    if (const size_t left = text_.size() - at_.next; element.count > (left + Numbers::bytes_in_excess) / least)
        fail_in_header(element.name, fmt::format("{} times '{}' take at least {} bytes each, but {} are left of the "
                                                 "file",
                                                 element.count, element.name, least, left));
}

template <class Numbers, class Take>
void PlyReader::read_elements(const PlyElement &element, Numbers &numbers, Take take) {
    for (number_ = 0; number_ < element.count; ++number_) {
        drop_text();
        numbers.begin();
        take();
        numbers.end();
    }
}

template <class Numbers> double PlyReader::take_length(const PlyProperty &property, Numbers &numbers) {
    const double length = numbers.number(property, *property.length_type);
    if (length < 0)
        fail_(at_.start, fmt::format("{} has {:.0f} numbers", quoted(property.name), length));
    numbers.check_room(property, length, property.type);
    return length;
}

template <class Numbers> void PlyReader::skip(const PlyProperty &property, Numbers &numbers) {
    for (double left = property.is_list() ? take_length(property, numbers) : 1; left > 0; --left)
        numbers.number(property, property.type);
}

template <class Numbers> void PlyReader::read_vertices(Numbers &numbers) {
    const size_t count = size_t(vertex_->count);
    check_memory(double(count) * double((1 + has_normals_) * sizeof(Vec3) + has_uvs_ * sizeof mesh_.uvs[0]),
                 fmt::format("{}: {} vertices", file_, count));
    mesh_.positions.reserve(count);
    if (has_normals_)
        mesh_.normals.reserve(count);
    if (has_uvs_)
        mesh_.uvs.reserve(count);
    read_elements(*vertex_, numbers, [&] {
        for (size_t i = 0; i < vertex_fields_.size(); ++i) {
            const PlyProperty &property = vertex_->properties[i];
            if (property.is_list())
                skip(property, numbers);
            else
                fields_[vertex_fields_[i]] = numbers.number(property, property.type);
        }
        add_vertex();
    });
}

// Adds the present element's.
void PlyReader::add_values(std::vector<AttributeReading> &attributes) {
    for (AttributeReading &reading : attributes)
        for (size_t channel = 0; channel < size_t(reading.made.channels); ++channel) {
            const float value = as_float(fields_[reading.first_field + channel]);
            reading.infinite += !std::isfinite(value);
            reading.made.values.push_back(std::isfinite(value) ? value : 0);
        }
}

void PlyReader::add_vertex() {
    const auto triple = [&](Field first) { return Vec3{fields_[first], fields_[first + 1], fields_[first + 2]}; };
    const Vec3 position = to_world_.point(triple(field_x));
    if (!fits_float(position))
        fail_(at_.start, fmt::format("vertex {} is not finite in single precision once transformed", number_));
    mesh_.positions.push_back(position);
    add_values(vertex_attributes_);
    bool finite = true;
    if (has_normals_) {
        const Vec3 normal = triple(field_nx);
        finite = std::isfinite(normal.x + normal.y + normal.z);
        mesh_.normals.push_back(finite ? unit_normal(to_world_, normal) : Vec3{});
    }
    if (has_uvs_) {
        const std::array<float, 2> uv = {as_float(fields_[field_u]), as_float(fields_[field_v])};
        finite = finite && std::isfinite(uv[0] + uv[1]);
        mesh_.uvs.push_back(uv);
    }
    if (!finite && infinite_++ == 0)
        first_infinite_ = place(at_.start);
}

template <class Numbers> void PlyReader::read_faces(Numbers &numbers) {
    if (face_->count == 0)
        return;
    const size_t least =
        Numbers::least_bytes(*corner_list_->length_type) + 3 * Numbers::least_bytes(corner_list_->type);
    const size_t count = size_t(std::min<uint64_t>(face_->count, (text_.size() - at_.next) / least + 1)); // triangles
    check_memory(double(count) * double(sizeof mesh_.triangles[0] + has_uvs_ * sizeof mesh_.uv_corners[0]),
                 fmt::format("{}: {} triangles", file_, count));
    mesh_.triangles.reserve(count);
    if (has_uvs_)
        mesh_.uv_corners.reserve(count);
    read_elements(*face_, numbers, [&] {
        for (size_t i = 0; i < face_->properties.size(); ++i) {
            const PlyProperty &property = face_->properties[i];
            if (&property != corner_list_) {
                if (face_fields_[i] == field_other)
                    skip(property, numbers);
                else
                    fields_[face_fields_[i]] = numbers.number(property, property.type);
                continue;
            }
            corners_.clear();
            for (double left = take_length(property, numbers); left > 0; --left) {
                const double index = numbers.number(property, property.type);
                if (!(index >= 0 && index < double(vertex_->count)))
                    fail_(at_.start, fmt::format("vertex index {:.0f} is out of range: the file has {} vertices", index,
                                                 vertex_->count));
                corners_.push_back(unsigned(index));
            }
        }
        add_face();
    });
}

void PlyReader::add_face() {
    if (corners_.size() < 3)
        return drop(0);
    if (corners_.size() == 3)
        return add_triangle(0, 1, 2);
    outline_.clear();
    for (unsigned corner : corners_)
        outline_.push_back(mesh_.positions[corner]);
    std::vector<std::array<unsigned, 3>> triangles;
    try {
        triangles = triangulate(outline_);
    } catch (const Error &error) {
        fail_(at_.start, error.what());
    }
    for (const auto &[a, b, c] : triangles)
        add_triangle(a, b, c);
}

// a, b, c: corners of the present face
void PlyReader::add_triangle(unsigned a, unsigned b, unsigned c) {
    const std::array<unsigned, 3> vertices = {corners_[a], corners_[b], corners_[c]};
    std::array<Vec3, 3> p;
    for (int i = 0; i < 3; ++i)
        p[i] = mesh_.positions[vertices[i]];
    if (const double rounding = rounding_of(p); !has_area(p, rounding))
        return drop(rounding);
    add_values(face_attributes_);
    auto &triangle = mesh_.triangles.emplace_back();
    Vec3 normals;
    for (int i = 0; i < 3; ++i) {
        triangle[i] = {vertices[i], none};
        if (has_normals_ && dot(mesh_.normals[vertices[i]], mesh_.normals[vertices[i]]) > 0) {
            triangle[i].normal = vertices[i];
            normals = normals + mesh_.normals[vertices[i]];
        }
    }
    const double side = dot(normals, cross(p[1] - p[0], p[2] - p[0])) * (is_mirrored_ ? -1 : 1);
    front_ += side > 0;
    back_ += side < 0;
    if (!has_uvs_)
        return;
    auto &uvs = mesh_.uv_corners.emplace_back();
    for (int i = 0; i < 3; ++i) {
        const auto &[u, v] = mesh_.uvs[vertices[i]];
        uvs[i] = std::isfinite(u + v) ? vertices[i] : none;
    }
}

// rounding: that of the triangle; 0 for a face of too few corners
void PlyReader::drop(double rounding) {
    if (dropped_triangles_.count++ == 0)
        dropped_triangles_.first_place = place(at_.start);
    dropped_triangles_.rounding = std::max(dropped_triangles_.rounding, rounding);
}

// Gives pages of the text that was read back, as those of the mesh are taken.
void PlyReader::drop_text() {
    constexpr size_t step = 1 << 20; // so that it takes few system calls
    if (!may_drop_ || at_.next < dropped_ + step)
        return;
    drop_pages(&text_[dropped_], at_.next - dropped_);
    dropped_ = at_.next;
}

TriangleMesh PlyReader::finish() {
    using Corner = TriangleMesh::Corner;
    if (back_ > 0 && front_ == 0)
        warn(fmt::format("{}: the normals are on the back of every face, by the order of its corners; they decide "
                         "which side is the front (Blender writes mirrored objects so)",
                         place_in_header(face_->name)));
    if (infinite_ > 0)
        warn(fmt::format("{}: a normal or texture coordinate is not finite: corners there have none{}", first_infinite_,
                         infinite_ == 1 ? "" : fmt::format(" ({} in the file)", infinite_)));
    free_memory(text_);
    TriangleMesh mesh;
    mesh.triangles = std::move(mesh_.triangles);
    mesh.uv_corners = std::move(mesh_.uv_corners);
    mesh.normals = compact(mesh_.normals, mesh.triangles, [](Corner &corner) -> unsigned & { return corner.normal; });
    free_memory(mesh_.normals);
    const auto position_of = [](Corner &corner) -> unsigned & { return corner.position; };
    if (vertex_attributes_.empty()) {
        mesh.positions = compact(mesh_.positions, mesh.triangles, position_of);
    } else {
        LargeVector<unsigned> vertices(mesh_.positions.size());
        std::iota(vertices.begin(), vertices.end(), 0);
        vertices = compact(vertices, mesh.triangles, position_of);
        for (unsigned vertex : vertices)
            mesh.positions.push_back(mesh_.positions[vertex]);
        for (AttributeReading &reading : vertex_attributes_)
            keep_values_of(vertices, reading.made);
    }
    free_memory(mesh_.positions);
    for (auto *list : {&vertex_attributes_, &face_attributes_})
        for (AttributeReading &reading : *list) {
            if (reading.infinite > 0)
                warn(fmt::format("{}: {} numbers of the attribute {} are NaN or infinite: they are taken as 0",
                                 reading.first_place, reading.infinite, reading.made.name));
            mesh.attributes.push_back(std::make_shared<const MeshAttribute>(std::move(reading.made)));
        }
    mesh.uvs = compact(mesh_.uvs, mesh.uv_corners, [](unsigned &index) -> unsigned & { return index; });
    if (mesh.uvs.empty())
        free_memory(mesh.uv_corners);
    warn_of_dropped(file_, dropped_triangles_, mesh);
    return mesh;
}

} // namespace

TriangleMesh read_ply(const std::filesystem::path &file, const Transform &to_world, FileHashes *hashes,
                      std::span<const std::string> attributes) {
    return PlyReader(file, to_world, hashes).read(attributes);
}

} // namespace opal
