#include "base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace opal {

namespace {

struct Character {
    size_t bytes = 1;
    bool valid = false;
    uint32_t code = 0;
};

// The character at the beginning of the text by UTF-8's table (Unicode 15, table 3-7): no overlong forms, no
// surrogates.
Character first_of(std::string_view text) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint32_t(static_cast<unsigned char>(text[i])) : 0; };
    const uint32_t lead = byte(0);
    if (lead < 0x80)
        return {1, true, lead};
    const size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
    uint32_t code = lead & (0x7fu >> length);
    for (size_t i = 1; i < length; i++) {
        if ((byte(i) & 0xc0) != 0x80)
            return {};
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr uint32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
    if (lead < 0xc2 || lead > 0xf4 || code < least[length] || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff))
        return {};
    return {length, true, code};
}

// Whether a character steers a terminal. Line separators break lines in editors and browsers.
bool steers(uint32_t code) {
    return (code < 0x20 && code != '\t' && code != '\n') || (code >= 0x7f && code <= 0x9f) || code == 0x61c ||
           code == 0x200e || code == 0x200f || (code >= 0x2028 && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
}

bool is_plain(char c) { return (c >= 0x20 && c < 0x7f) || c == '\t' || c == '\n'; }

// Replaces bytes that are not UTF-8, and characters that `replaced` tells, by what `escape` makes of them.
template <class Replaced, class Escape> std::string escaped(std::string_view text, Replaced replaced, Escape escape) {
    std::string result;
    for (size_t at = 0; at < text.size();) {
        const size_t plain = size_t(std::find_if_not(text.begin() + ptrdiff_t(at), text.end(), is_plain) -
                                    (text.begin() + ptrdiff_t(at)));
        result += text.substr(at, plain);
        if ((at += plain) == text.size())
            break;
        const Character c = first_of(text.substr(at));
        if (!c.valid)
            result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
        else if (replaced(c.code))
            result += escape(c.code);
        else
            result += text.substr(at, c.bytes);
        at += c.bytes;
    }
    return result;
}

std::string as_text(uint32_t code) {
    return code < 0x80 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
}

// The length of the quoted value at the beginning of the text; 0 if it has no end. An apostrophe within a word ends
// none.
size_t quoted_size(std::string_view text) {
    for (size_t at = text.find('\'', 1); at != text.npos; at = text.find('\'', at + 1))
        if (at + 1 == text.size() || std::string_view(" \n,;:.)").find(text[at + 1]) != std::string_view::npos)
            return at + 1;
    return 0;
}

} // namespace

std::string as_utf8(std::string_view text) {
    return escaped(
        text, [](uint32_t) { return false; }, as_text);
}

std::string printable(std::string_view text) { return escaped(text, steers, as_text); }

std::string printable_json(std::string json) {
    if (std::ranges::all_of(json, is_plain)) // most
        return json;
    return escaped(json, steers, [](uint32_t code) { return fmt::format("\\u{:04x}", code); });
}

std::string shortened(std::string_view text, size_t most) {
    if (text.size() <= most)
        return std::string(text);
    constexpr size_t words = 40; // of what tells how much is missing
    const auto continues = [&](size_t at) { return at < text.size() && (text[at] & 0xc0) == 0x80; };
    size_t head = 2 * (most - words) / 3, tail = text.size() - (most - words) / 3;
    while (head > 0 && continues(head)) // no character is cut
        head--;
    while (continues(tail))
        tail++;
    return fmt::format("{}[... {} bytes ...]{}", text.substr(0, head), tail - head, text.substr(tail));
}

std::string quoted(std::string_view text) { return "'" + shortened(text) + "'"; }

std::string shortened_message(const std::string &message) {
    constexpr size_t longest_word = 200, longest_line = 2000;
    std::string result, line;
    const std::string_view text = message;
    const auto end_word = [&](std::string_view word) { line += shortened(word, longest_word); };
    const auto end_line = [&] {
        result += shortened(line, longest_line);
        line.clear();
    };
    size_t begin = 0;
    bool may_end = true; // a quoted value; where one has no end, no later one has
    for (size_t at = 0; at < text.size(); at++) {
        if (at == begin && text[at] == '\'' && may_end) { // a quoted value, which may hold blanks
            const size_t size = quoted_size(text.substr(at));
            may_end = size > 0;
            if (size > longest_word) {
                line += shortened(text.substr(at, size), longest_word);
                begin = at += size;
                if (at == text.size())
                    break;
            }
        }
        if (text[at] != ' ' && text[at] != '\t' && text[at] != '\n')
            continue;
        end_word(text.substr(begin, at - begin));
        if (text[at] == '\n')
            end_line();
        (text[at] == '\n' ? result : line) += text[at];
        begin = at + 1;
    }
    end_word(text.substr(begin));
    end_line();
    return result;
}

std::string in_one_line(std::string message) {
    for (size_t at = message.find('\n'); at != std::string::npos; at = message.find('\n', at))
        message.replace(at, 1, "\\n");
    return message;
}

} // namespace opal
