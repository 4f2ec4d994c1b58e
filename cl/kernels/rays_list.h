// The kinds of rays of cl/kernels/rays.cl and its columns, written once for host and device.
#ifndef OPAL_RAYS_LIST_H
#define OPAL_RAYS_LIST_H

// The kinds of rays that are timed.
#define OPAL_RAY_KINDS(KIND) \
    KIND(camera, "through the pixels of tiles of 8 x 8, as a render sends them") \
    KIND(bounce, "from what the camera sees, distributed by the cosine") \
    KIND(shadow, \
         "from what the camera sees towards points sampled on the lights, or random points where there are none")

#define OPAL_RAY_KIND_ENUM(name, help) RAYS_##name,
enum { OPAL_RAY_KINDS(OPAL_RAY_KIND_ENUM) RAYS_KINDS };

// The columns of rays and hits, in the order in which --dump-rays and --dump-hits write them.
enum { TRACE_O_X, TRACE_O_Y, TRACE_O_Z, TRACE_TMIN, TRACE_D_X, TRACE_D_Y, TRACE_D_Z, TRACE_TMAX, TRACE_RAY_PLANES };
enum { TRACE_T, TRACE_U, TRACE_V, TRACE_TRIANGLE, TRACE_HIT_PLANES };

#endif
