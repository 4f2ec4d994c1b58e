// The counters of a program that counts its work (OPAL_COUNT_TESTS; host: BuildOptions::count_tests).
#ifndef OPAL_COUNTERS_H
#define OPAL_COUNTERS_H

enum {
    COUNTER_nodes,       // nodes of the tree that a ray tests, the root apart
    COUNTER_blocks,      // blocks of triangles that a ray tests
    COUNTER_rays,        // rays for closest hits
    COUNTER_shadow_rays,
    COUNTER_rounds,      // rounds of a work-item's loop, each of at most LANES rays
    COUNTERS
};

#endif
