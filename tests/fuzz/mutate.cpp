#include "fuzz/mutate.h"

#include <algorithm>
#include <cstring>

extern "C" size_t LLVMFuzzerMutate(std::uint8_t *data, size_t size, size_t max_size);

namespace opal::fuzz {

namespace {

// Ends of ranges, what rounds to them, and what only looks like a number.
const std::vector<std::string> numbers = {"0",
                                          "-0",
                                          "1",
                                          "-1",
                                          "2",
                                          "0.5",
                                          "1e-7",
                                          "1e38",
                                          "-1e38",
                                          "3.4028235e38",
                                          "3.5e38",
                                          "1e39",
                                          "1e308",
                                          "1e309",
                                          "1e-38",
                                          "1e-45",
                                          "1e-46",
                                          "5e-324",
                                          "1e-400",
                                          "1e-30",
                                          "1e30",
                                          "16777216",
                                          "16777217",
                                          "2147483647",
                                          "-2147483648",
                                          "2147483648",
                                          "65536",
                                          "4294967295",
                                          "4294967296",
                                          "18446744073709551616",
                                          "99999999999999999999",
                                          "nan",
                                          "-nan",
                                          "inf",
                                          "-inf",
                                          "1.#INF",
                                          "0x10",
                                          "1_0",
                                          "+1",
                                          "+-1",
                                          "1.",
                                          ".5",
                                          "1,5",
                                          "1e",
                                          "180",
                                          "179.9999",
                                          "-1e-45",
                                          ""};

// A piece of the text that begins at `start`, up to one of the next few starts.
std::string_view piece_at(std::string_view text, const std::vector<size_t> &starts, size_t at, Random &random) {
    const size_t end = at + 1 + below(4, random);
    return text.substr(starts[at], end < starts.size() ? starts[end] - starts[at] : std::string_view::npos);
}

void mutate_pieces(char begin, std::string &text, size_t max_size, Random &random) {
    std::vector<size_t> starts;
    for (size_t at = text.find(begin); at != text.npos; at = text.find(begin, at + 1))
        starts.push_back(at);
    if (starts.empty())
        return;
    const size_t from = below(starts.size(), random), to = below(starts.size(), random);
    const std::string piece(piece_at(text, starts, from, random));
    const size_t kind = below(4, random);
    if (kind == 0) { // left out
        text.erase(starts[from], piece.size());
    } else if (kind == 1) { // put in another's place
        text.replace(starts[to], piece_at(text, starts, to, random).size(), piece);
    } else { // doubled, or many times: as often as there is room for shows what takes more than linear time
        const size_t room = (std::max(max_size, text.size()) - text.size()) / piece.size();
        const size_t times = kind == 2 ? 1 : std::min(room, below(8, random) == 0 ? room : 1 + below(30, random));
        std::string pieces;
        for (size_t i = 0; i < times; i++)
            pieces += piece;
        text.insert(starts[to], pieces);
    }
}

void mutate_word(const TextFormat &format, std::string &text, Random &random) {
    const std::vector<std::string_view> words = format.words(text);
    if (words.empty())
        return;
    const std::string_view word = one_of(words, random);
    const size_t place = size_t(word.data() - text.data());
    const size_t kind = below(8, random);
    std::string other = kind < 3 || format.replacements.empty() ? one_of(numbers, random)
                        : kind < 6                              ? one_of(format.replacements, random)
                                                                : std::string(one_of(words, random));
    if (below(8, random) == 0) // several numbers of a list
        other += " " + one_of(numbers, random) + " " + one_of(numbers, random);
    text.replace(place, word.size(), other);
}

} // namespace

std::vector<std::string_view> separated(std::string_view text, std::string_view separators) {
    std::vector<std::string_view> words;
    for (size_t start = text.find_first_not_of(separators); start != text.npos;) {
        const size_t end = std::min(text.find_first_of(separators, start), text.size());
        words.push_back(text.substr(start, end - start));
        start = text.find_first_not_of(separators, end);
    }
    return words;
}

std::vector<std::string_view> quoted(std::string_view text) {
    std::vector<std::string_view> values;
    for (size_t open = text.find('"'); open != text.npos;) {
        const size_t close = text.find('"', open + 1);
        if (close == text.npos)
            break;
        values.push_back(text.substr(open + 1, close - open - 1));
        open = text.find('"', close + 1);
    }
    return values;
}

size_t mutate(const TextFormat &format, std::uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    Random random(seed);
    std::string text(reinterpret_cast<const char *>(data), size);
    if (format.start && (size < 2 || below(100, random) == 0))
        text = format.start(random);
    else if (below(2, random) == 0)
        return LLVMFuzzerMutate(data, size, max_size);
    else
        for (size_t times = 1 + below(3, random); times > 0; times--)
            if (below(3, random) == 0)
                mutate_pieces(format.piece, text, max_size, random);
            else
                mutate_word(format, text, random);
    size = std::min(text.size(), max_size);
    std::memcpy(data, text.data(), size);
    return size;
}

} // namespace opal::fuzz
