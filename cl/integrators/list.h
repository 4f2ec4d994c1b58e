// The integrators, a row each: INTEGRATOR(with, name, loop, asks, axes, help). From the rows come the choices of
// the axis `integrator`, dispatch.cl, the features of a kernel, the strategies that make sense, and the names that XML
// takes.
#ifndef OPAL_INTEGRATOR_LIST_H
#define OPAL_INTEGRATOR_LIST_H

// What an integrator asks of a scene, and what it can do with light.
enum {
    OPAL_ASKS_BSDFS = 1,      // evaluates or samples the materials of surfaces
    OPAL_ASKS_LIGHTS = 2,     // finds the scene's emitters: without the axis `lighting`, by emitter sampling alone
    OPAL_ASKS_OWN_LIGHT = 4,  // needs the light that its XML describes (SimpleLight)
    OPAL_FOLLOWS_PATHS = 8,   // goes on from diffuse surfaces by BSDF samples, whatever `lighting` says
    OPAL_ONE_SAMPLE_MIS = 16  // can take one of both samples (--mis one-sample), as no path goes on from it
};

// An axis that the integrator reads: its choices change the estimator. All integrators read `sampler`.
#define OPAL_READS(axis) (1u << AXIS_##axis)
#define OPAL_READS_LIGHT_SAMPLING (OPAL_READS(emitter_choice) | OPAL_READS(triangle_choice))
#define OPAL_READS_LIGHTING \
    (OPAL_READS_LIGHT_SAMPLING | OPAL_READS(lighting) | OPAL_READS(mis) | OPAL_READS(hemisphere))

// loop: the kernel file, kernels/LOOP.cl, whose entry point `render` drives it. `with` is passed through to INTEGRATOR.
#define OPAL_INTEGRATORS(INTEGRATOR, with) \
    INTEGRATOR(with, normals, render, 0, 0, "shading normals as colours") \
    INTEGRATOR(with, ao, render, 0, OPAL_READS(hemisphere), "ambient occlusion, unbounded") \
    INTEGRATOR(with, simple, render, OPAL_ASKS_OWN_LIGHT, 0, "one point light, no bounces") \
    INTEGRATOR(with, whitted, render, OPAL_ASKS_BSDFS | OPAL_ASKS_LIGHTS, OPAL_READS_LIGHT_SAMPLING, \
               "direct light by emitter sampling, specular surfaces followed") \
    INTEGRATOR(with, direct_lighting, render, OPAL_ASKS_BSDFS | OPAL_ASKS_LIGHTS | OPAL_ONE_SAMPLE_MIS, \
               OPAL_READS_LIGHTING, "one bounce of direct light") \
    INTEGRATOR(with, path, render, OPAL_ASKS_BSDFS | OPAL_ASKS_LIGHTS | OPAL_FOLLOWS_PATHS, \
               OPAL_READS_LIGHTING | OPAL_READS(rr), "full path tracing") \
    INTEGRATOR(with, av, render, 0, 0, "average visibility: the hemisphere's share in which nothing is near")

#endif
