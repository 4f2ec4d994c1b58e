#include "read/obj_statements.h"

#include "base/error.h"
#include "base/large_vector.h"
#include "base/values.h"
#include "read/file_kind.h"
#include "read/mesh_parts.h"
#include "read/xml.h"

#include <algorithm>
#include <charconv>

namespace opal {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

// A '#' begins a comment, but for the one in what Windows' old C library wrote for infinity and NaN.
size_t comment_in(std::string_view row) {
    const auto is_in_number = [row](size_t at) {
        const std::string_view left = row.substr(at + 1);
        return at > 0 && row[at - 1] == '.' &&
               (left.starts_with("IN") || left.starts_with("QNAN") || left.starts_with("SNAN"));
    };
    size_t at = row.find('#');
    while (at != row.npos && is_in_number(at))
        at = row.find('#', at + 1);
    return std::min(at, row.size());
}

// The slower parse_integer knows what is wrong, and forms that are rare.
int parse_index(std::string_view word) {
    int value;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() ? value : parse_integer(word);
}

} // namespace

ObjStatements::ObjStatements(const std::filesystem::path &file, FileHashes *hashes)
    : file_(file), text_(read_text_file(file, FileKind::obj, hashes)), can_be_read_again_(is_regular_file(file)) {}

void ObjStatements::free_text() { free_memory(text_); }

// Drops the text before the present position.
void ObjStatements::drop_text() {
    constexpr size_t step = 1 << 20; // so that it takes few system calls
    if (!can_be_read_again_ || position_ < dropped_ + step)
        return;
    drop_pages(&text_[dropped_], position_ - dropped_);
    dropped_ = position_;
}

void ObjStatements::rewind() {
    if (dropped_ > 0) {
        free_text();
        text_ = read_text_file(file_, FileKind::obj);
    }
    dropped_ = position_ = 0;
    lines_ = 0;
    absent = further_numbers = {};
}

std::string ObjStatements::rest() const {
    const size_t begin = size_t(words_[0].data() + words_[0].size() - text_.data());
    std::string rest = text_.substr(begin, position_ - 1 - begin);
    for (size_t at = rest.find('\n'); at != rest.npos; at = rest.find('\n')) // continued: without backslash and end
        rest.replace(rest.rfind('\\', at), at + 1 - rest.rfind('\\', at), " ");
    const auto first = std::find_if_not(rest.begin(), rest.end(), is_blank);
    return {first, std::find_if_not(rest.rbegin(), std::make_reverse_iterator(first), is_blank).base()};
}

SourcePlace ObjStatements::place(std::string_view word) const {
    SourcePlace place = place_in(file_.string(), std::string_view(text_).substr(statement_),
                                 word.data() - text_.data() - ptrdiff_t(statement_));
    place.line += lines_before_;
    return place;
}

void ObjStatements::fail(std::string_view word, const std::string &message) const {
    throw Error(place(word).text() + ": " + message);
}

void ObjStatements::count(ObjTally &tally, std::string_view word) const {
    if (tally.count++ == 0) {
        tally.word = word.substr(0, 40);
        tally.place = place(word);
    }
}

ObjStatements::int_type ObjStatements::underflow() {
    line_.clear();
    while (line_.empty()) {
        if (!next())
            return traits_type::eof();
        take_statement();
    }
    setg(line_.data(), line_.data(), line_.data() + line_.size());
    return traits_type::to_int_type(line_[0]);
}

// Reads the words of the next statement; false at the end of the text.
bool ObjStatements::next() {
    words_.clear();
    drop_text();
    while (words_.empty() && position_ < text_.size()) {
        statement_ = position_;
        lines_before_ = lines_;
        while (add_line()) {
        }
    }
    return !words_.empty();
}

// Adds the words of a line, and says whether it goes on in the next.
bool ObjStatements::add_line() {
    const size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view row = std::string_view(text_).substr(position_, end - position_);
    position_ = end + 1;
    ++lines_;
    row = row.substr(0, comment_in(row));
    const size_t last = row.find_last_not_of(" \t\r");
    const bool continued = last != row.npos && row[last] == '\\' && position_ < text_.size();
    if (continued)
        row = row.substr(0, last);
    // find_first_of would call memchr for every character.
    for (auto start = std::find_if_not(row.begin(), row.end(), is_blank); start != row.end();) {
        const auto stop = std::find_if(start, row.end(), is_blank);
        words_.emplace_back(start, stop);
        start = std::find_if_not(stop, row.end(), is_blank);
    }
    return continued;
}

// Leaves the line that the library has to read in line_; empty: none.
void ObjStatements::take_statement() {
    const std::string_view kind = words_[0];
    if (kind == "v") {
        if (words_.size() > 4)
            count(further_numbers, words_[4]);
        take_numbers(3, parse_coordinate);
    } else if (kind == "vn") {
        take_numbers(3, parse_coordinate_or_nan);
    } else if (kind == "vt") {
        take_numbers(1, parse_coordinate_or_nan);
    } else if (kind == "f" && words_.size() > 1) {
        line_ = kind;
        for (size_t i = 1; i < words_.size(); ++i)
            take_corner(words_[i]);
        line_ += '\n';
    } else {
        take_other();
    }
}

void ObjStatements::take_numbers(size_t least, double (*parse)(std::string_view)) {
    if (words_.size() <= least)
        fail(words_[0], "'" + std::string(words_[0]) + "' needs " + (least == 1 ? "a number" : "three numbers"));
    numbers_ = {};
    for (size_t i = 1; i < std::min(words_.size(), 1 + numbers_.size()); ++i) {
        try {
            numbers_[i - 1] = parse(words_[i]);
        } catch (const Error &error) {
            fail(words_[i], error.what());
        }
    }
    (line_ = words_[0]) += " 0 0 0\n";
}

// v, v/vt, v//vn or v/vt/vn, with nothing or 0 for a vt or vn that is absent.
void ObjStatements::take_corner(std::string_view word) {
    std::string_view parts[3];
    size_t parts_count = 0;
    for (std::string_view left = word; parts_count < 3;) {
        const size_t slash = std::min(left.find('/'), left.size());
        parts[parts_count++] = left.substr(0, slash);
        if (slash == left.size())
            break;
        if (parts_count == 3)
            fail(word, "'" + std::string(word) + "' has more than vertex/texture/normal");
        left.remove_prefix(slash + 1);
    }
    try {
        parse_index(parts[0]);
        for (std::string_view *part : {&parts[1], &parts[2]})
            if (!part->empty() && parse_index(*part) == 0) {
                count(absent, word);
                *part = {};
            }
    } catch (const Error &error) {
        fail(word, error.what());
    }
    (line_ += ' ') += parts[0];
    if (!parts[1].empty() || !parts[2].empty())
        (line_ += '/') += parts[1];
    if (!parts[2].empty())
        (line_ += '/') += parts[2];
}

} // namespace opal
