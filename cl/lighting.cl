// lighting: what integrators share: a path's state, light that is hit, light that is sampled, the next direction, roulette.
typedef struct {
    Ray ray;
    v3 throughput, radiance;
    v3 lost;         // what rounding took from radiance (add_radiance)
    real pdf;        // density of ray.d over solid angle where it was drawn
    real eta;        // product of the indices passed: throughput * eta^2 is free of refraction's scaling
    mask direct;     // no light sampling could have found what this ray hits: camera rays and discrete BSDFs
    uints depth;     // segments so far, this ray included
    Sampler sampler;
} Path;

// The pair `dimension` of the path's present segment.
static uints path_dimension(const Path *path, uint dimension) { return 1u + (path->depth - 1u) * (uint)DIMS_A_SEGMENT + dimension; }
static v2 path_draw(const Scene *scene, const Path *path, uint dimension) { return draw(scene, path->sampler, path_dimension(path, dimension)); }
static u2 path_draw_bits(const Scene *scene, const Path *path, uint dimension) { return draw_bits(scene, path->sampler, path_dimension(path, dimension)); }

// Adds light to the path's sum. Without roulette paths may be thousands of segments long, and the sum would lose 2e-5: what rounding takes
// is then kept for the next addition (Kahan 1965). With roulette, noise is far above that, and a GPU has no registers to spare.
static void add_radiance(const Scene *scene, Path *path, v3 light) {
    if (!CHOSEN(scene, rr, off)) {
        path->radiance = v3_add(path->radiance, light);
        return;
    }
    v3 term = v3_add(light, path->lost), sum = v3_add(path->radiance, term);
    path->lost = v3_sub(term, v3_sub(sum, path->radiance));
    path->radiance = sum;
}

// Weight of a sample whose own density is 1 against another of density `ratio` (Veach 1997, eq. 9.8 and 9.10). As a ratio it
// survives densities that are 0 or overflow.
static real mis_weight(const Scene *scene, real ratio) {
    return 1 / (1 + (CHOSEN(scene, mis, power) ? ratio * ratio : ratio));
}

// Radiance that the surface emits towards the viewer, weighted by how else it could have been found.
static v3 emitted(const Scene *scene, const Path *path, Surface s, mask found) {
    v3 none = v3_all((real)(0));
    if (EMITTER_KINDS == 0) return none;
    mask shining = found & to_mask(s.emitter != OPAL_NONE) & (s.wi.z > 0);
    if (CHOSEN(scene, lighting, emitter)) shining = shining & path->direct;
    if (!ANY(shining)) return none;
    uints id = OPAL_HAS_many_emitters ? uints_pick(shining, s.emitter, (uints)(0)) : (uints)(0);
    v3 radiance = emitter_radiance(scene, id);
    if (CHOSEN(scene, lighting, mis)) {
        // Both densities over solid angle; the light's is turned by distance^2 / cosine.
        real cosine = fabs(v3_dot(s.normal, path->ray.d));
        real ratio = emitter_area_pdf(scene, id, s.triangle, shining) * square(s.t) / (cosine * path->pdf);
        radiance = v3_scale(radiance, path->direct ? (real)(1) : mis_weight(scene, ratio));
    }
    return v3_pick(shining, radiance, none);
}

// What a point on a light adds to a path unless something lies on the way there.
typedef struct {
    v3 radiance;     // throughput included
    Ray shadow;
    mask live;       // the lanes that have such a point
} LightSample;

// Direct light by one point on one emitter, weighted against BSDF sampling where both are used. The way there is asked by unless_blocked, later:
// a processor then works at this and at scatter side by side.
static LightSample sample_light(const Scene *scene, const Path *path, Surface s, mask live) {
    LightSample sample;
    sample.radiance = sample.shadow.o = sample.shadow.d = v3_all((real)(0));
    sample.shadow.tmin = 0;
    sample.shadow.tmax = 1; // the light's surface
    sample.live = NO_LANES;
    if (EMITTER_KINDS == 0 || !ANY(live)) return sample;
    uints id = emitter_choose(scene, path_draw_bits(scene, path, DIM_EMITTER));
    EmitterSample light = emitter_sample(scene, id, path_draw(scene, path, DIM_LIGHT), path_draw_bits(scene, path, DIM_TRIANGLE), live);

    v3 to_light = v3_sub(light.p, s.p);
    real inverse_distance = rsqrt(v3_dot(to_light, to_light));
    v3 wo = to_local(s.frame, v3_scale(to_light, inverse_distance));
    mask facing = light.discrete | (v3_dot(light.facing, to_light) < 0);
    live = live & facing & (wo.z > 0) & (inverse_distance < FAR);
    if (!ANY(live)) return sample;

    // cos / distance^2 turns a density over area into one over solid angle.
    real cosine = light.discrete ? (real)(1) : fabs(v3_dot(light.normal, to_light)) * inverse_distance;
    real per_density = cosine * square(inverse_distance) * light.area / emitter_probability(scene, id);
    real bsdf_density;
    v3 f = bsdf_eval(scene, s.bsdf, s.wi, wo, live, &bsdf_density);
    if (CHOSEN(scene, lighting, mis)) {
        real weight = mis_weight(scene, light.discrete ? (real)(0) : bsdf_density * per_density);
        per_density = weight * per_density;
    }
    v3 light_in = v3_scale(v3_mul(f, emitter_radiance(scene, id)), wo.z * per_density);
    sample.live = live & ((v3_largest(light_in) > 0) | !is_finite(light_in)); // what is not finite must reach the film to be counted
    sample.radiance = v3_mul(path->throughput, light_in);

    // The ray ends above the light's surface as it starts above this one's.
    v3 end = v3_mad(light.normal, copysign(light.margin, -v3_dot(light.normal, to_light)), light.p);
    sample.shadow.o = leave_surface(s, to_light);
    sample.shadow.d = v3_sub(end, sample.shadow.o);
    return sample;
}

static v3 unless_blocked(const Scene *scene, LightSample sample) {
    v3 none = v3_all((real)(0));
    if (EMITTER_KINDS == 0 || !ANY(sample.live)) return none;
    mask blocked = any_hit_to_light(scene, sample.shadow, sample.live);
    if (OPAL_TWICE_traversal) blocked = any_hit_to_light(scene, same_ray(sample.shadow, blocked | (sample.shadow.o.x < FAR)), sample.live);
    COUNT_TESTS(scene, shadow_rays, count_lanes(sample.live));
    return v3_pick(sample.live & !blocked, sample.radiance, none);
}

// The least normal float. Below it a path carries nothing, nor may it go on: the least denormal times 0.9 is itself again, for ever.
#define THROUGHPUT_LEAST R(1.1754944e-38)

// The path's next segment, drawn by the BSDF. Returns the lanes whose path carries anything on.
static mask scatter(const Scene *scene, Path *path, Surface s, mask live) {
    v2 lobe = path_draw(scene, path, DIM_LOBE);
    BsdfSample sample = bsdf_sample(scene, s.bsdf, s.wi, path_draw(scene, path, DIM_BSDF), lobe.x, live);
    mask broken = live & !is_finite(sample.weight);
    if (ANY(broken)) { // ends here, and is counted
        path->radiance = v3_pick(broken, sample.weight, path->radiance);
        live = live & !broken;
    }
    live = live & (v3_largest(sample.weight) > 0);
    v3 d = to_world(s.frame, sample.wo);
    path->ray.o = leave_surface(s, d);
    path->ray.d = d;
    path->ray.tmin = 0;
    path->ray.tmax = FAR;
    path->throughput = v3_mul(path->throughput, sample.weight);
    path->eta = path->eta * sample.eta;
    path->direct = sample.discrete;
    if (CHOSEN(scene, lighting, mis)) path->pdf = sample.pdf;
    path->depth = path->depth + 1u;
    return live & (v3_largest(path->throughput) >= THROUGHPUT_LEAST);
}

// Survival stays below 1: total reflection can hold a path in glass for ever. No lower, so that a furnace of albedo a keeps
// finite variance, which needs a^2 < survival.
#define ROULETTE_MOST R(0.9999)

// Ends paths at random and makes up for them in those that go on. It looks at the pair that scatter drew its lobe from.
static mask roulette(const Scene *scene, Path *path, mask live, real u) {
    if (CHOSEN(scene, rr, off)) return live;
    real survival = scene->settings->rr_prob;
    if (!CHOSEN(scene, rr, fixed)) {
        survival = v3_largest(path->throughput);
        if (CHOSEN(scene, rr, throughput_eta)) survival = survival * square(path->eta);
        survival = drawn_probability(real_min(survival, (real)(ROULETTE_MOST)));
    }
    mask plays = live & to_mask(path->depth > scene->settings->rr_depth);
    path->throughput = v3_scale(path->throughput, plays ? 1 / survival : (real)(1));
    return live & (!plays | (u < survival));
}
