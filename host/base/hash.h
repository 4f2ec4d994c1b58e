// The hash XXH3 of 128 bits (Collet), by which files are told apart. It is not safe against forgery.
#pragma once

#include <string>
#include <string_view>

namespace opal {

std::string xxh128(std::string_view bytes); // 32 hexadecimal digits, as `xxh128sum` prints them

} // namespace opal
