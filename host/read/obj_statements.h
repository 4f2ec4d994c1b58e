// The strict pass over the text of an OBJ file, in front of tinyobjloader: checks every statement, and hands over those
// that the library reads right.
#pragma once

#include "base/hash.h"
#include "scene/place.h"

#include <array>
#include <filesystem>
#include <streambuf>
#include <string>
#include <string_view>
#include <vector>

namespace opal {

// How often something was met, and what and where first.
struct ObjTally {
    size_t count = 0;
    std::string word; // at most 40 characters of it
    SourcePlace place;
};

// A stream of clean statements, a line each: `v`, `vn`, `vt`, and `f` with its corners. Comments, repeated blanks,
// continued lines, and indices of `vt` and `vn` that are 0 or left out stay behind; other statements go to take_other.
// A line is made once the line before is read, so that a callback of the library can ask for the statement that it is
// called for. Its numbers, too: the library gets zeros in their place. It would add up their digits one by one, so that
// half of all numbers with six decimals are wrong in the last bits of a double, and call pow() for each digit beyond
// the seventh. Statements that were read leave memory, as the meshes that they make enter it. Throws Error
// "file:line:col: ..." for a malformed number or index, and those of read_text_file.
class ObjStatements : public std::streambuf {
public:
    ObjStatements(const std::filesystem::path &file, FileHashes *hashes);

protected:
    virtual void take_other() = 0; // a statement that is none of these four

    void rewind();    // to the first statement
    void free_text(); // once all statements are read

    // Of the present statement:
    using Words = std::vector<std::string_view>;
    const Words &words() const { return words_; }
    const std::array<double, 3> &numbers() const { return numbers_; } // in `vn` and `vt` NaN where not finite
    std::string rest() const; // of the line behind the first word, with comments, without blanks at the ends
    SourcePlace place(std::string_view word) const;
    [[noreturn]] void fail(std::string_view word, const std::string &message) const;
    void count(ObjTally &tally, std::string_view word) const;

    ObjTally absent;          // indices of `vt` and `vn` that mean none: 0, and what the reader adds
    ObjTally further_numbers; // statements `v` with weights or colours

private:
    int_type underflow() override;
    bool next();
    bool add_line();
    void take_statement();
    void take_numbers(size_t least, double (*parse)(std::string_view));
    void take_corner(std::string_view word);

    void drop_text();

    std::filesystem::path file_;
    std::string text_;
    bool can_be_read_again_;              // the file: it is no pipe
    size_t dropped_ = 0;                  // bytes of the text whose pages are dropped
    size_t position_ = 0, statement_ = 0; // offsets of the next line and of the present statement
    int lines_ = 0, lines_before_ = 0;    // lines before these offsets
    Words words_;
    std::array<double, 3> numbers_{};
    std::string line_; // what the library reads next
};

} // namespace opal
