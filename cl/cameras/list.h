// The cameras: one row, its parameters, its record and one file cl/cameras/NAME.cl each. NAME is also the XML type. The
// host fills the record in host/flatten/camera_NAME.cpp.
#ifndef OPAL_CAMERA_LIST_H
#define OPAL_CAMERA_LIST_H

#include "shared/glue.h"
#include "shared/parameters.h"

// Traits of a kind, as bits.
enum {
    OPAL_ONE_ORIGIN = 1, // all rays start at the camera's origin
    OPAL_DRAWS_LENS = 2  // a ray depends on a pair of random numbers, the point on the lens
};

// CAMERA(name, record, traits)
#define OPAL_CAMERAS(CAMERA) \
    CAMERA(perspective, PerspectiveCamera, OPAL_ONE_ORIGIN) \
    CAMERA(thinlens, ThinLensCamera, OPAL_DRAWS_LENS) \
    CAMERA(orthographic, OrthographicCamera, 0)

// The parameters of a kind, rows of shared/parameters.h. All are numbers in world units; the host reads them, and fills
// the kind's record below.
#define OPAL_CAMERA_perspective(PARAMETER) \
    PARAMETER(NUMBER, fov, "fov", 30, INSIDE(0, 180), "full horizontal angle, degrees") \
    PARAMETER(NUMBER, principal_point_x, "principalPointX", 0, ANY, \
              "how far right of the image's middle the axis meets it, in widths") \
    PARAMETER(NUMBER, principal_point_y, "principalPointY", 0, ANY, \
              "how far below the image's middle the axis meets it, in heights")
#define OPAL_CAMERA_thinlens(PARAMETER) \
    PARAMETER(NUMBER, fov, "fov", 30, INSIDE(0, 180), "full horizontal angle, degrees") \
    PARAMETER(NUMBER, aperture_radius, "lensRadius", 0, AT_LEAST(0), "radius of the lens") \
    PARAMETER(NUMBER, focus_distance, "focalDistance", 10, ABOVE(0), \
              "depth of the plane that is seen sharply")
#define OPAL_CAMERA_orthographic(PARAMETER)

#define OPAL_CAMERA_ENUM(name, record, traits) CAMERA_##name,
enum { OPAL_CAMERAS(OPAL_CAMERA_ENUM) CAMERA_COUNT };

#ifdef __cplusplus
namespace opal {
#endif

typedef struct {
    float tan_half_x, tan_half_y; // film half extents at distance 1
    float shift_x, shift_y;       // of the film at distance 1, to the left and up
} PerspectiveCamera;

typedef struct {
    float tan_half_x, tan_half_y; // film half extents at distance 1
    float aperture_radius;
    float inverse_focus;          // 1 / depth of the plane that is seen sharply
} ThinLensCamera;

typedef struct {
    float half_x, half_y; // film half extents, in lengths of `left` and `up`
} OrthographicCamera;

// The camera. Positions and distances are in the flattened scene's units (FlatScene::center, FlatScene::scale).
typedef struct {
    uint kind;                              // CAMERA_*, which says which member of `own` is meant
    float origin[3];
    float left[3], up[3], forward[3];       // columns of toWorld over the length of the third: a unit of depth
    float near_clip, far_clip;              // depths, along forward
    union {
#define OPAL_CAMERA_OWN(name, record, traits) record name;
        OPAL_CAMERAS(OPAL_CAMERA_OWN)
        float words[8];
    } own;
} CameraRecord;
OPAL_SIZE_CHECK(CameraRecord, 92);

#ifdef __cplusplus
}
#endif

#endif
