// The sentence of the Error that a call throws, for tests of bad input.
#pragma once

#include "base/error.h"

#include <string>

namespace opal::test {

// "" where nothing is thrown; any other exception passes.
template <class Call> std::string error_of(Call call) {
    try {
        call();
    } catch (const Error &error) {
        return error.what();
    }
    return "";
}

} // namespace opal::test
