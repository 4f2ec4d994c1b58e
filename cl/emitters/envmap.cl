// envmap: an environment whose radiance is an image, interpolated bilinearly between its texels. Directions are drawn
// with a density that is interpolated likewise: a cell between four texels is chosen by an alias table, and in it a
// place by the bilinear density of its corners.
//   <emitter type="envmap"> <string name="filename" value="sky.exr"/> </emitter>
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rng.cl"
#include "core/rows.cl"
#include "emitters/interface.cl"
#include "emitters/list.h"
#include "scene.cl"
#include "surface.cl"

// The map of a scene, the same in all lanes.
typedef struct {
    v3 x, y, z;           // its axes in world space
    uints width, height;
    real half_turn;       // from row to row, in turns: half a turn over the rows between the poles
} EnvironmentView;

// A place in a cell: texels to its left and right, its upper row, and how far it is from these, 0 to 1.
typedef struct {
    uints left, right, row;
    real s, t;
} EnvironmentPlace;

// A value at each corner of a cell: upper left, upper right, lower left, lower right.
typedef struct {
    v3 color[4];
} EnvironmentCorners;

// The environment's record, whatever emitter a lane means.
static global const emitter_envmap_record *environment_record(const Scene *scene) {
    return &scene->emitters[scene->settings->environment].u.of_envmap;
}

static EnvironmentView environment_view(const Scene *scene) {
    global const emitter_envmap_record *record = environment_record(scene);
    EnvironmentView map = {v3_from(record->to_local[0]), v3_from(record->to_local[1]), v3_from(record->to_local[2]),
                           (uints)(record->width), (uints)(record->height),
                           (real)(R(0.5) / (real1)(record->height - 1u))};
    return map;
}

// The texel to the right, where the last column is followed by the first.
static uints column_after(uints x, uints width) {
    uints next = x + 1u;
    return uints_pick(to_mask(next == width), (uints)(0), next);
}

// The place of a direction d, unit. Sets *sine to the sine of its angle to the map's y.
static EnvironmentPlace environment_place(EnvironmentView map, v3 d, real *sine) {
    real x = v3_dot(d, map.x), y = v3_dot(d, map.y), z = v3_dot(d, map.z);
    *sine = sqrt(mul_add(x, x, z * z));
    real turn = turn_of(x, -z);
    turn = turn < 0 ? turn + 1 : turn;
    real column = turn * to_real(map.width) - R(0.5), left = floor(column);
    ints first = to_ints(left), last = as_signed(map.width) - 1;
    first = first < 0 ? last : first > last ? (ints)(0) : first;
    real row = 2 * turn_of(*sine, y) * to_real(map.height - 1u);
    ints above = to_ints(row), last_above = as_signed(map.height) - 2;
    above = above < 0 ? 0 : above < last_above ? above : last_above;
    EnvironmentPlace place = {as_unsigned(first), column_after(as_unsigned(first), map.width), as_unsigned(above),
                              column - left, row - to_real(above)};
    return place;
}

static v3 environment_texel(const Scene *scene, uints texel) {
    return v3_at(scene->environment_texels->color, texel * (uint)(sizeof(EnvironmentTexel) / 4));
}

static EnvironmentCorners environment_corners(const Scene *scene, EnvironmentView map, EnvironmentPlace place) {
    uints upper = place.row * map.width, lower = upper + map.width;
    EnvironmentCorners corners = {
        {environment_texel(scene, upper + place.left), environment_texel(scene, upper + place.right),
         environment_texel(scene, lower + place.left), environment_texel(scene, lower + place.right)}};
    return corners;
}

// (1 - x) a + x b. a + x (b - a) would lose a dim texel beside a bright one.
static real real_mixed(real a, real b, real x) { return mul_add(b, x, a * (1 - x)); }

static v3 environment_color(EnvironmentCorners at, EnvironmentPlace place) {
    real weights[4] = {(1 - place.s) * (1 - place.t), place.s * (1 - place.t), (1 - place.s) * place.t,
                       place.s * place.t};
    v3 sum = v3_scale(at.color[0], weights[0]);
    for (int i = 1; i < 4; i++) sum = v3_mad(at.color[i], weights[i], sum);
    return sum;
}

// The sine of the angle between the map's y and a row, which lies `from_pole` rows from the nearer pole.
static real sine_of_row(real from_pole, EnvironmentView map) {
    return sin_2pi_of_quarter(from_pole * map.half_turn);
}

static real rows_from_pole(EnvironmentView map, uints row) {
    uints below = map.height - 1u - row;
    return to_real(uints_pick(to_mask(row < below), row, below));
}

// The densities of the corners in light sampling, over the unit square and 2 pi^2, in their order.
typedef struct {
    real of[4];
} EnvironmentDensities;

static EnvironmentDensities environment_densities(const Scene *scene, EnvironmentView map, EnvironmentCorners at,
                                                  EnvironmentPlace place) {
    global const emitter_envmap_record *record = environment_record(scene);
    real scale = record->density_scale, subtracted = record->subtracted, least = record->least;
    real sines[2] = {scale * sine_of_row(rows_from_pole(map, place.row), map),
                     scale * sine_of_row(rows_from_pole(map, place.row + 1u), map)};
    EnvironmentDensities densities;
    for (int i = 0; i < 4; i++)
        densities.of[i] = real_max(luminance(at.color[i]) - subtracted, least) * sines[i / 2];
    return densities;
}

// A place in [0, 1) whose density is proportional to a at 0, to b at 1, and linear between, by u in [0, 1). The squares
// of densities stay in the range of single precision.
static real linear_place(real a, real b, real u) {
    real root = sqrt(real_mixed(a * a, b * b, u));
    return real_min(u * (a + b) / real_max(a + root, (real)(R(1e-30))), (real)(1 - EPSILON));
}

static LightSample emitter_envmap_sample(const Scene *scene, uints id, v3 color, ReferencePoint from, v2 u, u2 bits) {
    EnvironmentView map = environment_view(scene);
    // bits.x 2^-32 + bits.y 2^-64 times the number of cells: a cell, and of what is left 32 bits, steps of 2^-32.
    uints cells = map.width * (map.height - 1u);
    uints low = bits.x * cells, rest = low + mul_hi(bits.y, cells);
    uints cell = mul_hi(bits.x, cells) + uints_pick(to_mask(rest < low), (uints)(1), (uints)(0));
    mask kept = to_real(rest) * (GRID_STEP / 256) < GATHER(real, scene->environment_texels, cell, .accept);
    cell = uints_pick(kept, cell, GATHER(uints, scene->environment_texels, cell, .other));

    // The quotient of reals may be off by one.
    ints row = to_ints(to_real(cell) / to_real(map.width)), width = as_signed(map.width);
    ints left = as_signed(cell) - row * width;
    row = left < 0 ? row - 1 : left >= width ? row + 1 : row;
    EnvironmentPlace place;
    place.row = as_unsigned(row);
    place.left = cell - place.row * map.width;
    place.right = column_after(place.left, map.width);
    EnvironmentCorners corners = environment_corners(scene, map, place);
    EnvironmentDensities at = environment_densities(scene, map, corners, place);
    place.t = linear_place(at.of[0] + at.of[1], at.of[2] + at.of[3], u.y);
    real at_left = real_mixed(at.of[0], at.of[2], place.t), at_right = real_mixed(at.of[1], at.of[3], place.t);
    place.s = linear_place(at_left, at_right, u.x);
    real density = real_mixed(at_left, at_right, place.s);

    // Sines keep their digits near both poles.
    real above = to_real(place.row) + place.t, below = to_real(map.height - 1u - place.row) - place.t;
    real polar = real_min(above, below) * map.half_turn, sine = sin_2pi_of_quarter(polar);
    real from_equator = sin_2pi_of_quarter(R(0.25) - polar), cosine = above < below ? from_equator : -from_equator;
    v2 turn = cos_sin_2pi((to_real(place.left) + place.s + R(0.5)) / to_real(map.width));
    v3 d = v3_mad(map.x, sine * turn.y, v3_mad(map.y, cosine, v3_scale(map.z, -sine * turn.x)));
    mask active = density > 0;
    return light_sample_of(d, (real)(FAR), v3_mul(color, environment_color(corners, place)),
                           active ? sine / density : (real)(0), from.p, active);
}

static v3 emitter_envmap_radiance(const Scene *scene, uints id, v3 color, v3 d, const Surface *s) {
    EnvironmentView map = environment_view(scene);
    real sine;
    EnvironmentPlace place = environment_place(map, d, &sine);
    return v3_mul(color, environment_color(environment_corners(scene, map, place), place));
}

static real emitter_envmap_pdf(const Scene *scene, uints id, ReferencePoint from, v3 d, const Surface *s) {
    EnvironmentView map = environment_view(scene);
    real sine;
    EnvironmentPlace place = environment_place(map, d, &sine);
    EnvironmentDensities at = environment_densities(scene, map, environment_corners(scene, map, place), place);
    real above = real_mixed(at.of[0], at.of[1], place.s), below = real_mixed(at.of[2], at.of[3], place.s);
    real density = real_mixed(above, below, place.t);
    return sine > 0 ? density / sine : (real)(0);
}
