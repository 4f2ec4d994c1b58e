#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <cstdlib>

// In tests alone a driver's remark on a kernel is an error; the processes that they start inherit it.
[[maybe_unused]] static const int strict = setenv("OPAL_KERNEL_FLAGS", "-Werror", 0);
