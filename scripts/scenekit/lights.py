"""Scenes about light sources: Veach's plates, a furnace, mesh lights, many lights, spots."""
import math

from scenekit.shapes import Surface, icosphere, polygons, torus_knot
from scenekit.vec import add, cross, dot, luminance, norm, scale, sub
from scenekit.write import Scene, diffuse, microfacet, path_tracer, phong, rotate, scaling, translate

BLACK = diffuse(0, 0, 0)
GREY = diffuse(0.5, 0.5, 0.5)


def radiance(tint, power, area):
    """Radiance of a diffuse emitter of that luminous power: power = pi area luminance(radiance)."""
    return scale(tint, power / (math.pi * area * luminance(tint)))


def veach_mis():
    scene = Scene("veach_mis", """
Four plates of growing roughness under four spherical lights of equal power and growing size, after figure 9.2 of
E. Veach, Robust Monte Carlo Methods for Light Transport Simulation (1997); our own measures. Each plate is turned so that
the lights are mirrored into the camera at its middle. Smooth plates with large lights want BSDF sampling, rough plates
with small lights want emitter sampling. A dielectric of index 5 stands for the metal.""")
    eye, lights = (0, 2, 16), (0, 0.6, 0)
    scene.camera(eye, (0, -1.75, 0), 36, 600, 400)
    scene.parallelogram((-20, -3.6, 20), (40, 0, 0), (0, 0, -25), diffuse(0.6, 0.6, 0.6))
    scene.parallelogram((-20, -3.6, -5), (40, 0, 0), (0, 20, 0), diffuse(0.6, 0.6, 0.6))
    places = [(-0.85, 1), (-1.48, 2.6), (-2.01, 4.2), (-2.39, 5.8)]
    for (y, z), alpha, depth in zip(places, (0.005, 0.02, 0.05, 0.1), (1.4, 1.3, 1.2, 1.1)):
        middle = (0, y, z)
        up = norm(add(norm(sub(eye, middle)), norm(sub(lights, middle))))
        edge = scale(cross(up, (1, 0, 0)), depth)  # (1,0,0) x edge points along up
        half = 0.25 * (eye[2] - z)  # the same width in the picture
        corner = sub(sub(middle, scale(edge, 0.5)), (half, 0, 0))
        scene.parallelogram(corner, (2 * half, 0, 0), edge, microfacet(alpha, (0.06, 0.06, 0.06), 5))
    tints = [(1, 0.85, 0.7), (1, 1, 0.8), (0.8, 1, 0.85), (0.75, 0.85, 1)]
    area = icosphere(2).area()
    for x, r, tint in zip((-3.2, -1.3, 0.6, 3), (0.033, 0.1, 0.3, 0.9), tints):
        scene.mesh("sphere_320_flat", BLACK, scaling(r), translate(x, lights[1], lights[2]),
                   radiance=radiance(tint, 45, area * r * r))
    return scene


def furnace_mesh():
    """An icosphere wound outwards whose vn, one a face, point inwards: the vn decide, so the inside is the front."""
    sphere = icosphere(1, smooth=False)
    for k, face in enumerate(sphere.faces):
        a, b, c = (sphere.positions[i] for i, _ in face)
        sphere.normals.append(scale(norm(cross(sub(b, a), sub(c, a))), -1))
        sphere.faces[k] = tuple((i, k) for i, _ in face)
    return sphere


def furnace():
    scene = Scene("furnace", """
A furnace: a closed sphere whose wall has albedo a = 0.6 everywhere and emits Le = 0.2 everywhere. Radiance is then the
same at every point and in every direction, so the rendering equation L = Le + a L gives L = Le / (1 - a) = 0.5: every
pixel of every full path tracer has this mean. The mesh is wound outwards and its vn point inwards; the vn count.""",
                  ('<integrator type="path_mis">',), 64, filter="gaussian")
    scene.camera((0.2, 0.1, -0.3), (0, 0, 1), 70, 128, 128)
    scene.mesh("furnace", diffuse(0.6, 0.6, 0.6), radiance=(0.2, 0.2, 0.2))
    return scene


def room(scene, lo, hi, left, right, rest):
    """Five walls seen from inside; the side of the camera (high z) stays open."""
    (a, b, c), (d, e, f) = lo, hi
    scene.quad((a, b, f), (d, b, f), (a, b, c), rest)  # floor
    scene.quad((a, e, c), (d, e, c), (a, e, f), rest)  # ceiling
    scene.quad((a, b, c), (d, b, c), (a, e, c), rest)  # back
    scene.quad((a, b, f), (a, b, c), (a, e, f), left)
    scene.quad((d, b, c), (d, b, f), (d, e, c), right)


def mesh_light():
    scene = Scene("mesh_light", """
A glowing (2, 3) torus knot over two diffuse blocks: an area light of 1920 triangles that shadows and lights itself.""")
    scene.camera((0, 1.9, 7.6), (0, 1.55, 0), 40, 480, 360)
    room(scene, (-2.4, 0, -2), (2.4, 3.4, 3), diffuse(0.2, 0.35, 0.6), diffuse(0.6, 0.35, 0.15), diffuse(0.65, 0.65, 0.65))
    scene.mesh("knot_light", BLACK, rotate((1, 0, 0), 60), scaling(0.8), translate(0, 2.1, 0), radiance=(4.2, 3.6, 2.7))
    scene.mesh("cube", GREY, rotate((0, 1, 0), 25), scaling(0.8, 0.7, 0.8), translate(-1.5, -0.01, 0.1))
    scene.mesh("cube", GREY, rotate((0, 1, 0), -35), scaling(0.7, 0.45, 0.7), translate(0.6, -0.01, 0.8))
    return scene


def spiral_mesh(turns=3, steps_per_turn=40, shrink=4.5):
    """Ribbon along a logarithmic spiral in the xy plane, front +z: each turn is `shrink` times smaller than the last."""
    def edges(k):
        t = k / steps_per_turn
        r, a = shrink ** -t, 2 * math.pi * t
        return (r * math.cos(a), r * math.sin(a), 0), (0.6 * r * math.cos(a), 0.6 * r * math.sin(a), 0)

    quads = []
    for k in range(turns * steps_per_turn):
        (outer, inner), (outer2, inner2) = edges(k), edges(k + 1)
        quads.append([inner, outer, outer2, inner2])
    return polygons(quads)


def spiral_light():
    scene = Scene("spiral_light", """
A mesh light whose triangles differ in area by a factor of about 10000: a ribbon along a logarithmic spiral. Choosing its
triangles in proportion to their area draws the whole light evenly; choosing them uniformly spends most samples on the
tiny ones in the middle (the axis triangle-choice).""", path_tracer(mis=False))
    scene.camera((1.2, 1.7, 6.5), (0, 1.45, 0), 44, 480, 360)
    room(scene, (-2.5, 0, -2), (2.5, 3.2, 3.2), diffuse(0.55, 0.2, 0.2), diffuse(0.2, 0.45, 0.25), diffuse(0.6, 0.6, 0.6))
    scene.mesh("spiral_light", BLACK, scaling(1.1), translate(0, 1.75, -1.9), radiance=(13, 11.7, 9.3))
    scene.mesh("sphere_1280", diffuse(0.6, 0.6, 0.6), scaling(0.5), translate(-1.1, 0.5, 0.2))
    scene.mesh("cube", GREY, rotate((0, 1, 0), 30), scaling(0.7, 1, 0.7), translate(0.6, -0.01, 0.3))
    return scene


def many_lights():
    scene = Scene("many_lights", """
64 lamps of equal size whose powers span four decades, scattered over a field: most of the light comes from a few of them.
Choosing an emitter by its power follows that; choosing uniformly spends the same on each (the axis emitter-choice).""",
                  path_tracer(mis=False))
    scene.camera((0, 9, 17), (0, 0.2, 0.8), 42, 600, 400)
    scene.parallelogram((-30, 0, 30), (60, 0, 0), (0, 0, -60), diffuse(0.5, 0.5, 0.5))
    area, r = icosphere(1, smooth=False).area(), 0.12
    for k in range(64):
        x, z = 1.7 * (k % 8 - 3.5), 1.7 * (k // 8 - 3.5)
        height = 0.5 + 0.25 * (k * 11 % 5)
        power = 110 * 10 ** (-4 * (k * 29 % 64) / 63)
        tint = ((1, 0.8, 0.55), (0.7, 0.85, 1), (1, 0.95, 0.85))[k % 3]
        scene.mesh("cube", GREY, scaling(0.3, height, 0.3), rotate((0, 1, 0), 13 * k), translate(x, -0.01, z))
        scene.mesh("sphere_80_flat", BLACK, scaling(r), translate(x, height + r + 0.01, z),
                   radiance=radiance(tint, power, area * r * r))
    return scene


def spot_lens():
    scene = Scene("spot_lens", """
Spots and moonlight on a stage, through a lens that is focused on the knot in the middle: what is nearer or farther is
blurred. No ray meets these lights by chance, so that all light is found by light sampling.""")
    eye, middle = (0.5, 1.75, 6.2), (0, 0.62, 0)
    scene.camera(eye, (0, 0.7, 0), 32, 600, 400, lens=(0.16, math.dist(eye, middle)))
    scene.mesh("checker_light", diffuse(0.6, 0.55, 0.48), scaling(0.9), translate(0, 0, -1))
    scene.mesh("checker_dark", diffuse(0.16, 0.13, 0.12), scaling(0.9), translate(0, 0, -1))
    scene.parallelogram((-12, 0, -7), (24, 0, 0), (0, 9, 0), diffuse(0.35, 0.28, 0.3))
    scene.mesh("knot", microfacet(0.12, (0.55, 0.16, 0.1)), rotate((1, 0, 0), 78), scaling(0.42), translate(*middle))
    scene.mesh("vase", microfacet(0.05, (0.08, 0.3, 0.34)), scaling(0.8), translate(-1.35, 0, 1.9))
    scene.mesh("torus", microfacet(0.2, (0.5, 0.38, 0.08)), rotate((0, 0, 1), 12), scaling(0.36), translate(1.25, 0.18, 1.6))
    for k in range(7):
        angle = 0.45 * k - 1.35
        scene.mesh("sphere_1280", phong((0.5, 0.5, 0.55), (0.4, 0.4, 0.4), 0.6, 60), scaling(0.11),
                   translate(1.5 * math.sin(angle), 0.11, -1.5 * math.cos(angle) + 0.4))
    scene.mesh("vase", diffuse(0.7, 0.66, 0.6), scaling(1.1), translate(1.7, 0, -3.2))
    scene.mesh("vase", microfacet(0.1, (0.3, 0.1, 0.25)), scaling(0.9), translate(-1.5, 0, -3.6))
    scene.spot((-2.2, 4.6, 3), middle, (150, 124, 84), 18, 10)
    scene.spot((3.4, 3.8, 2.6), (1.25, 0.1, 1.6), (56, 70, 98), 15, 6)
    scene.spot((-3, 4, 4.2), (-1.35, 0.5, 1.9), (70, 84, 80), 15, 8)
    scene.spot((1.7, 5, -2.6), (1.7, 0.4, -3.2), (120, 80, 46), 16, 6)
    scene.spot((-1.2, 5, -4.4), (-1.5, 0.5, -3.6), (60, 80, 150), 17, 8)
    scene.sun((0.5, -1, -0.35), (0.28, 0.35, 0.5))
    return scene


def meshes():
    return {"furnace": (furnace_mesh(), "Furnace: 80 faces wound outwards, vn inwards"),
            "sphere_80_flat": (icosphere(1, smooth=False), "Unit sphere, 80 triangles, no vn"),
            "sphere_320_flat": (icosphere(2, smooth=False), "Unit sphere, 320 triangles, no vn"),
            "knot_light": (torus_knot(2, 3, 1, 0.4, 0.12, 96, 10), "(2, 3) torus knot, 1920 triangles"),
            "spiral_light": (spiral_mesh(), "Logarithmic spiral ribbon, triangle areas over a factor of about 10000")}


def scenes():
    return [veach_mis(), furnace(), mesh_light(), spiral_light(), many_lights(), spot_lens()]
