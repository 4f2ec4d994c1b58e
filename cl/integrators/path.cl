// path: path tracing (Kajiya 1986) with BSDF sampling, next-event estimation or both with MIS (--lighting), and Russian roulette.
//   nee, mis, rr, rr_prob of path_tracer_recursive; path_mats, path_ems, path_mis name the three kinds of lighting
static mask path_step(const Scene *scene, Path *path, Hit hit, mask live) {
    mask found = live & to_mask(hit.slot != OPAL_NONE);
    if (!ANY(found)) return found;
    Surface s = surface_at(scene, path->ray, hit, found);

    // Light that was hit
    add_radiance(scene, path, v3_mul(path->throughput, emitted(scene, path, s, found)));
    found = found & to_mask(path->depth < scene->settings->max_depth);
    if (!ANY(found)) return found;

    // Light that is sampled
    mask lit = CHOSEN(scene, lighting, bsdf) ? NO_LANES : found & !bsdf_is_discrete(scene, s.bsdf);
    LightSample light = sample_light(scene, path, s, lit);

    // The next segment
    real u = path_draw(scene, path, DIM_LOBE).y;
    found = scatter(scene, path, s, found);
    found = roulette(scene, path, found, u);

    add_radiance(scene, path, unless_blocked(scene, light));
    return found;
}
