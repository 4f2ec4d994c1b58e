// ao: ambient occlusion: the cosine-weighted share of the hemisphere, unbounded, that nothing blocks.
//   cosine_sampling   draw directions in proportion to their cosine (--hemisphere cosine), else uniformly
static mask ao_step(const Scene *scene, Path *path, Hit hit, mask live) {
    mask found = live & to_mask(hit.slot != OPAL_NONE);
    Surface s = surface_at(scene, path->ray, hit, found);
    v2 u = path_draw(scene, path, DIM_BSDF);
    int cosine = CHOSEN(scene, hemisphere, cosine);
    v3 wo = cosine ? square_to_cosine_hemisphere(u) : square_to_uniform_hemisphere(u);
    real weight = cosine ? (real)(1) : 2 * wo.z; // cos/pi over the density
    v3 d = to_world(s.frame, wo);
    Ray ray = {leave_surface(s, d), d, (real)(0), (real)(FAR)};
    mask open = found & !any_hit(scene, ray, found);
    path->radiance = v3_pick(open, v3_all(weight), path->radiance);
    return NO_LANES;
}
