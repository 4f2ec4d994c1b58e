#include "plot/svg.h"

#include "base/printable.h"

#include <fmt/format.h>

#include <cmath>

namespace opal {

double LogAxis::operator()(double value) const { return from + (to - from) * (std::log10(value) - low) / (high - low); }

std::string svg_line(double x0, double y0, double x1, double y1, const std::string &attributes) {
    return fmt::format("<line x1='{:.1f}' y1='{:.1f}' x2='{:.1f}' y2='{:.1f}' {}/>\n", x0, y0, x1, y1, attributes);
}

std::string svg_text(double x, double y, const std::string &attributes, const std::string &words) {
    return fmt::format("<text x='{:.1f}' y='{:.1f}' {}>{}</text>\n", x, y, attributes, html_text(words));
}

std::string html_text(const std::string &plain) {
    std::string out;
    for (char c : as_utf8(plain))
        out += c == '&'    ? "&amp;"
               : c == '<'  ? "&lt;"
               : c == '>'  ? "&gt;"
               : c == '"'  ? "&quot;"
               : c == '\'' ? "&#39;"
                           : std::string(1, c);
    return out;
}

std::string svg_file(std::string svg) {
    const std::string tag = "<svg ";
    if (svg.starts_with(tag))
        svg.replace(0, tag.size(), "<svg xmlns='http://www.w3.org/2000/svg' style='background: white' ");
    return svg;
}

} // namespace opal
