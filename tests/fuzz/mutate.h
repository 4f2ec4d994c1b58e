// Mutations of text by its words and pieces, which know a format: bytes alone seldom make an input that a parser lets
// in.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace opal::fuzz {

using Random = std::minstd_rand;
inline size_t below(size_t count, Random &random) { return random() % count; }
template <class List> const auto &one_of(const List &list, Random &random) { return list[below(list.size(), random)]; }

struct TextFormat {
    // The words that may be replaced.
    std::function<std::vector<std::string_view>(std::string_view)> words;
    // Words that hurt, beside numbers that do.
    std::vector<std::string> replacements;
    char piece = '\n'; // with which pieces begin that may be doubled, moved or left out
    // A whole input to start from; empty: the seeds are files.
    std::function<std::string(Random &)> start{};
};

// The words between separators.
std::vector<std::string_view> separated(std::string_view text, std::string_view separators);
// The values between quotation marks, as of XML's attributes.
std::vector<std::string_view> quoted(std::string_view text);

// Makes one mutation in `data`, by the format or, as often, by libFuzzer, which knows the dictionary. Returns the new
// size. It is what LLVMFuzzerCustomMutator returns.
size_t mutate(const TextFormat &format, std::uint8_t *data, size_t size, size_t max_size, unsigned seed);

} // namespace opal::fuzz
