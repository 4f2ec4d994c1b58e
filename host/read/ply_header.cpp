#include "read/ply_header.h"

#include "base/error.h"
#include "base/printable.h"
#include "base/table.h"
#include "read/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace opal {

namespace {

struct TypeRow {
    std::string_view name;
    PlyType type;
};
constexpr TypeRow types[] = {{"char", PlyType::int8},       {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
                             {"uint8", PlyType::uint8},     {"short", PlyType::int16},     {"int16", PlyType::int16},
                             {"ushort", PlyType::uint16},   {"uint16", PlyType::uint16},   {"int", PlyType::int32},
                             {"int32", PlyType::int32},     {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
                             {"float", PlyType::float32},   {"float32", PlyType::float32}, {"double", PlyType::float64},
                             {"float64", PlyType::float64}, {"int64", PlyType::int64},     {"uint64", PlyType::uint64}};

struct FormatRow {
    std::string_view name;
    PlyFormat format;
};
constexpr FormatRow formats[] = {{"ascii", PlyFormat::ascii},
                                 {"binary_little_endian", PlyFormat::little_endian},
                                 {"binary_big_endian", PlyFormat::big_endian}};

constexpr size_t longest_statement = 5; // words: property list uchar int vertex_indices

class HeaderParser {
public:
    HeaderParser(const std::filesystem::path &file, std::string_view text) : file_(file.string()), text_(text) {
        if (const std::string_view mark = "\xef\xbb\xbf"; text.starts_with(mark)) // of UTF-8
            position_ = mark.size();
    }

    PlyHeader parse() {
        next_line();
        if (words_.empty() || words_[0] != "ply")
            fail(line_, "is no PLY file: it does not begin with a line 'ply'");
        for (next_line(); words_.empty() || words_[0] != "end_header"; next_line())
            if (!words_.empty())
                take_statement();
        expect_words(1, "end_header");
        if (!has_format_)
            fail(words_[0], "the header has no line 'format'");
        finish_element();
        header_.end = position_;
        return std::move(header_);
    }

private:
    std::string file_;
    std::string_view text_, line_;
    size_t position_ = 0; // of the next line
    std::vector<std::string_view> words_;
    PlyHeader header_;
    bool has_format_ = false;
    std::string_view element_; // the word 'element' of the present one

    [[noreturn]] void fail(std::string_view word, const std::string &message) const {
        throw Error(place_in(file_, text_, word.data() - text_.data()).text() + ": " + message);
    }

    // Any words: the line may be that of a file of another kind.
    void next_line() {
        const size_t end = text_.find('\n', position_);
        if (end == text_.npos)
            fail(text_.substr(position_), header_.lines == 0 ? "is no PLY file: it does not begin with a line 'ply'"
                                                             : "the file ends before 'end_header'");
        line_ = text_.substr(position_, end - position_);
        position_ = end + 1;
        ++header_.lines;
        if (line_.ends_with('\r'))
            line_.remove_suffix(1);
        if (const size_t at = line_.find('\r'); at != line_.npos && header_.lines == 1)
            fail(line_.substr(at), "lines of the header end with a carriage return alone, as on old Macintoshes");
        split_line();
    }

    void split_line() {
        const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
        words_.clear();
        for (auto start = std::find_if_not(line_.begin(), line_.end(), is_blank); start != line_.end();) {
            const auto stop = std::find_if(start, line_.end(), is_blank);
            words_.emplace_back(start, stop);
            if (words_[0] == "comment" || words_[0] == "obj_info" || words_.size() > longest_statement)
                return;
            start = std::find_if_not(stop, line_.end(), is_blank);
        }
    }

    void expect_words(size_t count, const char *form) const {
        if (words_.size() != count)
            fail(words_.size() > count ? words_[count] : words_[0], fmt::format("a line '{}' is expected", form));
    }

    template <class Rows> const auto &find(const Rows &rows, const char *what, std::string_view word) const {
        try {
            return find_row(rows, what, word);
        } catch (const Error &error) {
            fail(word, error.what());
        }
    }

    void take_statement() {
        const std::string_view kind = words_[0];
        if (kind == "format")
            take_format();
        else if (kind == "element")
            take_element();
        else if (kind == "property")
            take_property();
        else if (kind != "comment" && kind != "obj_info")
            fail(kind, unknown_name("statement of a PLY header", kind,
                                    {"format", "comment", "obj_info", "element", "property", "end_header"}));
    }

    void take_format() {
        if (has_format_)
            fail(words_[0], "a second line 'format'");
        expect_words(3, "format ascii 1.0");
        header_.format = find(formats, "format", words_[1]).format;
        if (words_[2] != "1.0")
            fail(words_[2], "the version is " + quoted(words_[2]) + "; available: 1.0");
        has_format_ = true;
    }

    void take_element() {
        expect_words(3, "element NAME COUNT");
        finish_element();
        element_ = words_[0];
        PlyElement &element = header_.elements.emplace_back();
        element.name = words_[1];
        const std::string_view count = words_[2];
        const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (error != std::errc() || end != count.data() + count.size())
            fail(count, quoted(count) + " is no count of elements");
    }

    void finish_element() const {
        if (!header_.elements.empty() && header_.elements.back().count > 0 &&
            header_.elements.back().properties.empty())
            fail(element_, "the element has no properties");
    }

    void take_property() {
        if (header_.elements.empty())
            fail(words_[0], "a property before the first element");
        const bool is_list = words_.size() > 1 && words_[1] == "list";
        if (is_list)
            expect_words(5, "property list TYPE TYPE NAME");
        else
            expect_words(3, "property TYPE NAME");
        PlyProperty property{words_.back(), find(types, "type", words_[words_.size() - 2]).type, {}};
        if (is_list) {
            property.length_type = find(types, "type", words_[2]).type;
            if (!is_integer(*property.length_type))
                fail(words_[2], "the count of a list is no whole number");
        }
        header_.elements.back().properties.push_back(property);
    }
};

} // namespace

std::string_view name_of(PlyType type) {
    return std::find_if(std::begin(types), std::end(types), [type](const TypeRow &row) { return row.type == type; })
        ->name;
}

PlyHeader parse_ply_header(const std::filesystem::path &file, std::string_view text) {
    return HeaderParser(file, text).parse();
}

} // namespace opal
