// The strategy axes and their choices, each name written once: command-line flag, JSON key, kernel constant.
//
// A row's name is spelled with '_' here and with '-' on the command line. The device asks CHOSEN(scene, lighting, mis),
// which is a constant where the kernel is specialised; the general kernel reads it from Settings.
#ifndef OPAL_STRATEGY_H
#define OPAL_STRATEGY_H

#include "integrators/list.h"

// What a strategy and a scene must have for an axis to matter, beside an integrator that reads the axis. The host finds
// it in strategies/combinations.cpp.
enum {
    OPAL_NEEDS_MIS = 1,              // both kinds of samples
    OPAL_NEEDS_EMITTER_SAMPLES = 2,
    OPAL_NEEDS_MANY_EMITTERS = 4,
    OPAL_NEEDS_MESH_LIGHTS = 8,      // a light of several triangles
    OPAL_NEEDS_DIFFUSE_SAMPLES = 16, // BSDF samples of diffuse surfaces, or directions that the integrator draws
    OPAL_NEEDS_ROULETTE = 32         // paths that are long enough for it
};

// AXIS(name, needs, help); its choices are the rows of OPAL_CHOICES_name.
#define OPAL_AXES(AXIS) \
    AXIS(integrator, 0, "what the image estimates") \
    AXIS(lighting, 0, "how light is found: by BSDF sampling, by emitter sampling, or by both with MIS") \
    AXIS(mis, OPAL_NEEDS_MIS, "how MIS weighs its two samples (Veach 1997, section 9.2)") \
    AXIS(hemisphere, OPAL_NEEDS_DIFFUSE_SAMPLES, "how a diffuse surface draws directions") \
    AXIS(emitter_choice, OPAL_NEEDS_EMITTER_SAMPLES | OPAL_NEEDS_MANY_EMITTERS, \
         "how an emitter is chosen for light sampling") \
    AXIS(triangle_choice, OPAL_NEEDS_EMITTER_SAMPLES | OPAL_NEEDS_MESH_LIGHTS, \
         "how a triangle is chosen within a mesh light") \
    AXIS(rr, OPAL_NEEDS_ROULETTE, "Russian roulette: how the probability to survive is found") \
    AXIS(sampler, 0, "where the random numbers come from")

// CHOICE(axis, name, help).
#define OPAL_INTEGRATOR_CHOICE(CHOICE, name, loop, asks, axes, help) CHOICE(integrator, name, help)
#define OPAL_CHOICES_integrator(CHOICE) OPAL_INTEGRATORS(OPAL_INTEGRATOR_CHOICE, CHOICE)

#define OPAL_CHOICES_lighting(CHOICE) \
    CHOICE(lighting, bsdf, "follow BSDF samples until they hit a light") \
    CHOICE(lighting, emitter, "sample points on lights (next-event estimation)") \
    CHOICE(lighting, mis, "both, weighted by multiple importance sampling")

#define OPAL_CHOICES_mis(CHOICE) \
    CHOICE(mis, balance, "balance heuristic") \
    CHOICE(mis, power, "power heuristic, beta = 2") \
    CHOICE(mis, one_sample, "one of both with probability 1/2, balance heuristic (direct_lighting only)")

#define OPAL_CHOICES_hemisphere(CHOICE) \
    CHOICE(hemisphere, material, "what each material's use_cosine says") \
    CHOICE(hemisphere, uniform, "uniform over the hemisphere") \
    CHOICE(hemisphere, cosine, "in proportion to the cosine")

#define OPAL_CHOICES_emitter_choice(CHOICE) \
    CHOICE(emitter_choice, power, "in proportion to the emitted power; all alike where it is the same") \
    CHOICE(emitter_choice, uniform, "all alike")

#define OPAL_CHOICES_triangle_choice(CHOICE) \
    CHOICE(triangle_choice, area, "in proportion to the area") \
    CHOICE(triangle_choice, uniform, "all alike")

#define OPAL_CHOICES_rr(CHOICE) \
    CHOICE(rr, off, "paths end by --max-depth or when they carry nothing") \
    CHOICE(rr, fixed, "survive with one probability, --rr-prob") \
    CHOICE(rr, throughput, "survive in proportion to the throughput") \
    CHOICE(rr, throughput_eta, "throughput without the (1/eta)^2 that refraction scaled it by")

#define OPAL_CHOICES_sampler(CHOICE) \
    CHOICE(sampler, independent, "hashed, every number on its own") \
    CHOICE(sampler, stratified, "jittered strata, shuffled for each dimension") \
    CHOICE(sampler, sobol, "Owen-scrambled Sobol pairs (Burley 2020)")

#define OPAL_AXIS_ENUM(axis, needs, help) AXIS_##axis,
enum { OPAL_AXES(OPAL_AXIS_ENUM) AXIS_COUNT };

#define OPAL_CHOICE_ENUM(axis, choice, help) CHOICE_##axis##_##choice,
#define OPAL_CHOICES_ENUM(axis, needs, help) enum { OPAL_CHOICES_##axis(OPAL_CHOICE_ENUM) };
OPAL_AXES(OPAL_CHOICES_ENUM)

#endif
