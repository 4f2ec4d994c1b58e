// camera: rays through the film, and the pixel filters.
//
// The film position (sx, sy) in [0, 1]^2 has its origin top-left; camera space looks along +z with +x left in the image.

// Place of a sample within its pixel, in [0, 1)^2.
static v2 film_offset(const Scene *scene, Sampler s) { return draw(scene, s, (uints)(DIM_FILM)); }

// The ray of a sample at `offset` in pixel (x, y): unit direction, clipped by the planar near and far distances.
static Ray camera_ray(const Scene *scene, uints x, uints y, v2 offset) {
    global const Settings *settings = scene->settings;
    real sx = (to_real(x) + offset.x) / (real1)settings->width;
    real sy = (to_real(y) + offset.y) / (real1)settings->height;
    v3 d = v3_mad(v3_from(settings->camera_left), (1 - 2 * sx) * settings->tan_half_x,
                  v3_mad(v3_from(settings->camera_up), (1 - 2 * sy) * settings->tan_half_y, v3_from(settings->camera_forward)));
    real length = sqrt(v3_dot(d, d)); // a planar distance z is met at z * length along the unit direction
    Ray ray = {v3_from(settings->camera_origin), v3_scale(d, 1 / length), settings->near_clip * length, settings->far_clip * length};
    return ray;
}

// Weight of a sample at distance (x, y) from a pixel's centre, in pixels (SCENE_FORMAT section 3).
static real filter_1d(global const Settings *settings, real x) {
    real a = fabs(x), radius = settings->filter_radius;
    real w = 1;
    if (settings->filter == FILTER_tent) w = real_max(1 - a / radius, (real)(0));
    if (settings->filter == FILTER_gaussian) {
        real falloff = R(-0.5) / (square((real)(settings->filter_stddev)));
        w = real_max(exp(falloff * a * a) - exp(falloff * radius * radius), (real)(0));
    }
    if (settings->filter == FILTER_mitchell) { // Mitchell and Netravali 1988, eq. 8
        real t = 2 * a / radius, t2 = t * t, b = settings->filter_b, c = settings->filter_c;
        real inner = ((12 - 9 * b - 6 * c) * t + (-18 + 12 * b + 6 * c)) * t2 + (6 - 2 * b);
        real outer = (((-b - 6 * c) * t + (6 * b + 30 * c)) * t + (-12 * b - 48 * c)) * t + (8 * b + 24 * c);
        w = (t < 1 ? inner : outer) / 6;
    }
    return a <= radius ? w : (real)(0);
}
