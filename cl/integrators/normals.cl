// normals: shading normals as colours: |n|, or n/2 + 1/2 where `signed` is true.
static mask normals_step(const Scene *scene, Path *path, Hit hit, mask live) {
    mask found = live & to_mask(hit.slot != OPAL_NONE);
    v3 n = surface_at(scene, path->ray, hit, found).frame.n;
    v3 color = scene->settings->normals_signed ? v3_mad(n, (real)(R(0.5)), v3_all((real)(R(0.5)))) : v3_abs(n);
    path->radiance = v3_pick(found, color, path->radiance);
    return NO_LANES;
}
