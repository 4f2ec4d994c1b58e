// Glue by which a header can be read by OpenCL C 1.2 and by C++20.
//
// A shared struct holds only float, int, uint, arrays and structs of these: no float3, bool, size_t, pointers or enums,
// whose size or alignment differ between compilers. OPAL_SIZE_CHECK after a struct holds its size on both sides.
#ifndef OPAL_GLUE_H
#define OPAL_GLUE_H

#ifndef __cplusplus
#define OPAL_SIZE_CHECK(T, bytes) typedef char T##_size_check[sizeof(T) == (bytes) ? 1 : -1]
#else
namespace opal {
using uint = unsigned int;
}
#define OPAL_SIZE_CHECK(T, bytes) static_assert(sizeof(T) == (bytes))
#endif

#endif
