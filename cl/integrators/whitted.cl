// whitted: what surfaces emit plus one bounce of direct light by emitter sampling; specular surfaces are followed, with
// probability 0.95 (Nori's assignment 4; Whitted 1980).
#define WHITTED_SURVIVAL R(0.95)

static mask whitted_step(const Scene *scene, Path *path, Hit hit, mask live) {
    mask found = live & to_mask(hit.slot != OPAL_NONE);
    if (!ANY(found)) return found;
    Surface s = surface_at(scene, path->ray, hit, found);
    path->radiance = v3_add(path->radiance, v3_mul(path->throughput, emitted(scene, path, s, found)));
    found = found & to_mask(path->depth < scene->settings->max_depth);
    mask specular = found & bsdf_is_discrete(scene, s.bsdf);
    path->radiance = v3_add(path->radiance, unless_blocked(scene, sample_light(scene, path, s, found & !specular)));
    if (!ANY(specular)) return specular;
    real u = path_draw(scene, path, DIM_LOBE).y;
    Choice survives = choose((real)(WHITTED_SURVIVAL), u);
    path->throughput = v3_scale(path->throughput, 1 / survives.probability);
    return scatter(scene, path, s, specular) & survives.first;
}
