// Elements of SVG plots, as text.
#pragma once

#include <string>

namespace opal {

// A logarithmic axis: decades [low, high] lie at pixels [from, to].
struct LogAxis {
    double low, high, from, to;
    double operator()(double value) const; // the pixel of a positive value
};

// attributes: further ones, "class='minor'". The text is escaped.
std::string svg_line(double x0, double y0, double x1, double y1, const std::string &attributes);
std::string svg_text(double x, double y, const std::string &attributes, const std::string &words);

std::string html_text(const std::string &plain); // escapes &, <, >, quotes, and bytes that are not UTF-8

// Makes a stand-alone SVG file of an SVG element for a page.
std::string svg_file(std::string svg);

} // namespace opal
