// What libpng calls where it fails.
#pragma once

#include <png.h>

#include <stdexcept>

namespace opal {

[[noreturn]] inline void throw_png_error(png_structp, png_const_charp what) { throw std::runtime_error(what); }
inline void ignore_png_warning(png_structp, png_const_charp) {}

} // namespace opal
