// The host's memory that is left to this process.
#pragma once

#include <string>

namespace opal {

// Throws Error unless that much is left: `resident` bytes, by the limits of the process's control group and those above
// it (cgroups(7), both versions; cached files count as free) and by /proc/meminfo; and `reserved` bytes of addresses,
// by the process's own limits (getrlimit(2)). Both are those of the peak to come. What nobody knows is no limit. what:
// "an image of 640 x 480 pixels".
void check_memory(double resident, double reserved, const std::string &what);

// The same, of memory that is filled as soon as it is reserved.
inline void check_memory(double bytes, const std::string &what) { check_memory(bytes, bytes, what); }

} // namespace opal
