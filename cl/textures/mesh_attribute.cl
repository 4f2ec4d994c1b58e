// mesh_attribute: numbers that a mesh has at its vertices or on its faces, between vertices by barycentric weights.
//   <texture name="reflectance" type="mesh_attribute"> <string name="name" value="vertex_color"/> </texture>
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "textures/interface.cl"
#include "textures/list.h"

static v3 texture_mesh_attribute_color(const Scene *scene, uints at, TexturePoint point, mask active) {
    global const texture_mesh_attribute_record *record =
        (global const texture_mesh_attribute_record *)scene->textures;
    uints channels = GATHER_WORD(uints, &record->channels, at);
    mask grey = to_mask(channels == 1u), of_face = to_mask(GATHER_WORD(uints, &record->corners, at) == 1u);
    uints first = GATHER_WORD(uints, &record->first, at) + GATHER_WORD(uints, &record->stride, at) * point.primitive;
    uints to_next = uints_pick(of_face, (uints)(0), channels);
    real weight[3] = {1 - point.b1 - point.b2, point.b1, point.b2};
    v3 sum = v3_all((real)(0));
    for (uint corner = 0; corner < 3; corner++) {
        uints red = uints_pick(active, first + corner * to_next, (uints)(0));
        uints green = uints_pick(active & !grey, red + 1u, red), blue = green + (green - red);
        v3 value = v3_of(GATHER_WORD(real, scene->attributes, red), GATHER_WORD(real, scene->attributes, green),
                         GATHER_WORD(real, scene->attributes, blue));
        sum = v3_mad(value, weight[corner], sum);
    }
    return v3_scale(sum, GATHER_WORD(real, &record->scale, at));
}
