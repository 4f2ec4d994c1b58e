// point: a point light of the same intensity in all directions; only light sampling finds it.
//   <emitter type="point"> <point name="position" value="0 1 0"/> <color name="power" value="10 10 10"/> </emitter>
static EmitterSample emitter_point_sample(const Scene *scene, uints id, v2 point, u2 triangle) {
    EmitterSample s;
    s.p = GATHER_V3(scene->emitters, id, .origin);
    s.normal = s.facing = v3_all((real)(0));
    s.area = 1;
    s.margin = 0;
    s.discrete = ALL_LANES;
    return s;
}
