#include "base/values.h"

#include "base/error.h"
#include "base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

namespace opal {

namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view text) {
    size_t first = text.find_first_not_of(blanks);
    return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

// std::from_chars on all of the text, after a '+' which it does not know.
template <class T> std::errc read_all(std::string_view text, T &value) {
    text = trimmed(text);
    if (text.starts_with('+') && !text.starts_with("+-"))
        text.remove_prefix(1);
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

} // namespace

bool parse_boolean(std::string_view text) {
    std::string lower(trimmed(text));
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    if (lower != "true" && lower != "false")
        throw Error(quoted(text) + " is not a boolean; available: true, false");
    return lower == "true";
}

int parse_integer(std::string_view text) {
    int value = 0;
    std::errc error = read_all(text, value);
    if (error == std::errc::result_out_of_range)
        throw Error(quoted(text) + " is too large for an integer");
    if (error != std::errc())
        throw Error(quoted(text) + " is not an integer");
    return value;
}

double parse_number(std::string_view text) {
    double value = 0;
    std::errc error = read_all(text, value);
    if (error == std::errc::invalid_argument)
        throw Error(quoted(text) + " is not a number");
    if (error == std::errc::result_out_of_range && std::abs(std::strtod(std::string(text).c_str(), nullptr)) < 1)
        return 0; // too small, as 1e-400, not too large
    if (error != std::errc() || !(std::abs(value) <= std::numeric_limits<float>::max()))
        throw Error(quoted(text) + " is not a finite number in single precision");
    return value;
}

std::vector<std::string_view> split(std::string_view text) {
    constexpr std::string_view separators = ", \t\r\n";
    std::vector<std::string_view> pieces;
    for (size_t start = text.find_first_not_of(separators); start != std::string_view::npos;) {
        size_t end = std::min(text.find_first_of(separators, start), text.size());
        pieces.push_back(text.substr(start, end - start));
        start = text.find_first_not_of(separators, end);
    }
    return pieces;
}

std::vector<std::string> lines_of(const std::string &text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<double> parse_numbers(std::string_view text, size_t count) {
    std::vector<double> numbers;
    for (std::string_view piece : split(text))
        numbers.push_back(parse_number(piece));
    if (numbers.size() != count)
        throw Error(quoted(text) + " holds " + std::to_string(numbers.size()) + " numbers, not " +
                    std::to_string(count));
    return numbers;
}

Vec3 parse_triple(std::string_view text) {
    std::vector<double> n = parse_numbers(text, 3);
    return {n[0], n[1], n[2]};
}

} // namespace opal
