"""Scenes about materials: Phong lobes, microfacet roughness, glass and caustics, and the room of everything."""
import math

from scenekit.lights import BLACK, room
from scenekit.shapes import band, box, height_field, icosphere, join, lathe, polygons, segment, torus, torus_knot
from scenekit.vec import scale
from scenekit.write import Scene, bsdf, diffuse, microfacet, phong, rotate, scaling, translate

GLASS, MIRROR = bsdf("dielectric"), bsdf("mirror")


def checker(parity, n=16):
    """Every other square of the unit squares over [-n/2, n/2]^2, front up."""
    squares = [(i - n // 2, j - n // 2) for i in range(n) for j in range(n) if (i + j) % 2 == parity]
    return polygons([[(x, 0, z + 1), (x + 1, 0, z + 1), (x + 1, 0, z), (x, 0, z)] for x, z in squares])


def checkered_floor(scene, size):
    scene.mesh("checker_dark", diffuse(0.15, 0.15, 0.17), scaling(size))
    scene.mesh("checker_light", diffuse(0.6, 0.6, 0.58), scaling(size))


def row(name, purpose, materials):
    """Spheres side by side on a checkered floor under a large and a small light."""
    scene = Scene(name, purpose)
    scene.camera((0, 3.2, 11), (0, 0.75, 0), 40, 640, 256)
    checkered_floor(scene, 1)
    scene.parallelogram((-8, 0, -3), (16, 0, 0), (0, 8, 0), diffuse(0.4, 0.45, 0.5))
    step = 7.6 / len(materials)
    for k, material in enumerate(materials):
        scene.mesh("sphere_1280", material, scaling(0.46 * step), translate(step * (k - (len(materials) - 1) / 2), 0.46 * step, 0))
    scene.parallelogram((-3, 5.5, 1), (6, 0, 0), (0, -1, 2), BLACK, (9, 8.5, 7.6))
    scene.parallelogram((-4.5, 3.2, 4.5), (0.3, 0, 0.1), (0.1, -0.3, 0.1), BLACK, (260, 280, 320))
    return scene


def caustic():
    scene = Scene("caustic", """
A glass sphere and a glass ring on a floor under a small lamp, a mirror behind them: caustics, which emitter sampling cannot
reach through glass, so every one of their paths meets the lamp by chance.""", spp=256)
    scene.camera((0, 3, 7.5), (0, 0.75, -0.2), 38, 480, 360)
    white = diffuse(0.65, 0.63, 0.6)
    room(scene, (-3, 0, -2.5), (3, 4, 8.5), diffuse(0.5, 0.25, 0.2), diffuse(0.2, 0.35, 0.5), white)
    scene.quad((3, 0, 8.5), (-3, 0, 8.5), (3, 4, 8.5), white)
    scene.quad((-1.6, 0.5, -2.45), (1.9, 0.5, -2.45), (-1.6, 2.6, -2.3), MIRROR)
    scene.mesh("sphere_5120", GLASS, scaling(0.75), translate(-0.95, 0.77, 0.2))
    scene.mesh("glass_ring", GLASS, translate(1, 0.01, 0.7))
    scene.mesh("sphere_1280", MIRROR, scaling(0.28), translate(1, 0.28, 0.7))
    scene.parallelogram((1.4, 3.9, 0.6), (0.6, 0, 0), (0, 0, 0.6), BLACK, (110, 104, 92))
    return scene


def spheres():
    scene = Scene("spheres", """
Exact spheres in a spiral, as the seeds of a sunflower lie, around a large one of glass: glass, mirrors, diffuse ones, and
five that are lamps, one of them above. Those far out are large.""", spp=256)
    scene.camera((0, 5, 9), (0, 0.35, 0.1), 35, 480, 360)
    scene.parallelogram((-12, 0, 12), (24, 0, 0), (0, 0, -24), diffuse(0.3, 0.3, 0.32))
    scene.sphere((0, 1, 0), 1, GLASS)
    colors = [(0.75, 0.2, 0.12), (0.85, 0.5, 0.12), (0.8, 0.75, 0.55), (0.15, 0.42, 0.45), (0.1, 0.2, 0.45)]
    tints = [(1, 0.55, 0.25), (1, 0.75, 0.45), (0.45, 0.75, 1), (1, 0.6, 0.5)]
    lamps = [24, 39, 55, 70]
    for k in range(14, 84):
        angle, away = k * math.pi * (3 - math.sqrt(5)), 0.42 * math.sqrt(k)
        r = 0.1 + 0.0018 * k
        center = (away * math.cos(angle), r, away * math.sin(angle))
        if k in lamps:
            scene.sphere(center, r, BLACK, scale(tints[lamps.index(k)], 16))
        elif k % 5 == 0:
            scene.sphere(center, r, GLASS)
        elif k % 7 == 0:
            scene.sphere(center, r, MIRROR)
        else:
            scene.sphere(center, r, diffuse(*colors[k % len(colors)]))
    scene.sphere((-3.5, 6, 1.5), 1.2, BLACK, (38, 36, 33))
    return scene


def vase():
    """A vessel of height 1.6 with a wall 0.06 thick: foot, belly, neck, lip, and the inside down to its floor."""
    radius = lambda y: 0.2 + 0.32 * math.sin(math.pi * min(1, y / 1.2)) ** 2 * (1 - 0.25 * y) + 0.1 * max(0, y - 1.2) ** 2
    outside = lambda s: (radius(1.6 * s), 1.6 * s)
    inside = lambda s: (radius(1.6 - 1.5 * s) - 0.06, 1.6 - 1.5 * s)
    return join([lathe(segment((0, 0), outside(0)), 1, 32), lathe(outside, 20, 32), lathe(segment(outside(1), inside(0)), 1, 32),
                 lathe(inside, 18, 32), lathe(segment(inside(1), (0, 0.1)), 1, 32)])


def curtain(x, z):
    return 0.06 * math.sin(9 * x + 0.8 * math.sin(2 * z)) + 0.03 * math.sin(17 * x - 1.5 * z)


def carpet(x, z):
    return 0.02 + 0.015 * math.sin(11 * x + 2 * math.sin(3 * z)) * math.sin(9 * z)


def table(scene, x, z, wood):
    scene.mesh("cube", wood, scaling(2.4, 0.08, 1.3), translate(x - 1.2, 0.92, z - 0.65))
    for dx, dz in [(-1.1, -0.55), (1, -0.55), (-1.1, 0.45), (1, 0.45)]:
        scene.mesh("cube", wood, scaling(0.1, 0.935, 0.1), translate(x + dx, -0.01, z + dz))


def shelves(scene, wood):
    """Three boards on the left wall, each with a row of balls of its own size."""
    kinds = [diffuse(0.6, 0.2, 0.15), microfacet(0.1, (0.1, 0.3, 0.5)), MIRROR, diffuse(0.3, 0.5, 0.2), microfacet(0.3, (0.5, 0.4, 0.1))]
    for board in range(3):
        y, count, r = 0.9 + 0.8 * board, (4, 5, 7)[board], (0.24, 0.18, 0.12)[board]
        scene.mesh("cube", wood, scaling(0.7, 0.05, 3.2), translate(-3.995, y, -2.6))
        for k in range(count):
            scene.mesh("sphere_320", kinds[(k + board) % 5], scaling(r), translate(-3.6, y + 0.05 + r, -2.2 + 2.6 * k / count))


def mixed_room():
    scene = Scene("mixed_room", """
A room of about 50 thousand triangles of very mixed size, of all materials but Phong, under four area lights (two panels, a globe, a
glowing knot): furniture of boxes, balls, rings, knots, vases, beads, a curtain and a carpet. Many meshes share an OBJ file.""")
    scene.camera((1.1, 2, 3.8), (-0.1, 1.1, -1.2), 66, 640, 400)
    wall, wood = diffuse(0.68, 0.66, 0.6), diffuse(0.42, 0.26, 0.14)
    room(scene, (-4, 0, -4), (4, 3.2, 4), diffuse(0.35, 0.45, 0.5), diffuse(0.6, 0.5, 0.35), wall)
    scene.quad((4, 0, 4), (-4, 0, 4), (4, 3.2, 4), wall)
    scene.parallelogram((-2.6, 3.18, -2.2), (1.4, 0, 0), (0, 0, 1), BLACK, (14, 13.2, 12))
    scene.parallelogram((1.2, 3.18, 0.5), (1.4, 0, 0), (0, 0, 1), BLACK, (14, 13.2, 12))
    scene.quad((0.2, 1, -3.96), (2.2, 1, -3.96), (0.2, 2.6, -3.96), MIRROR)
    scene.mesh("height_carpet", diffuse(0.45, 0.12, 0.12), scaling(3.6, 1, 2.6), translate(-0.2, 0, -0.6))
    scene.mesh("height_curtain", diffuse(0.2, 0.3, 0.45), scaling(2.4, 1, 3), rotate((1, 0, 0), 90), translate(-1.9, 1.6, -3.85))
    shelves(scene, wood)
    table(scene, 0.2, -1.2, wood)
    scene.mesh("sphere_1280", GLASS, scaling(0.22), translate(-0.45, 1.222, -1.1))
    scene.mesh("vase", microfacet(0.05, (0.1, 0.3, 0.35)), scaling(0.5), translate(0.25, 1.002, -1.45))
    scene.mesh("torus", microfacet(0.15, (0.5, 0.35, 0.05)), scaling(0.24), translate(0.75, 1.064, -0.95))
    scene.mesh("glass_ring", GLASS, scaling(0.3), translate(1.12, 1.002, -1.4))
    for k in range(50):  # a string of beads on the table
        t = k / 50
        scene.mesh("sphere_320", (MIRROR, diffuse(0.7, 0.65, 0.6))[k % 2], scaling(0.017),
                   translate(-0.9 + 1.9 * t, 1.0175, -0.72 + 0.06 * math.sin(14 * t)))
    scene.mesh("knot", microfacet(0.08, (0.45, 0.1, 0.1)), rotate((1, 0, 0), 70), scaling(0.42), translate(2.7, 1.24, -2.2))
    scene.mesh("cube", wall, scaling(0.7, 0.71, 0.7), translate(2.35, -0.01, -2.55))
    scene.mesh("sphere_1280", MIRROR, scaling(0.42), translate(-2.1, 0.42, -2.4))
    scene.mesh("sphere_1280", diffuse(0.55, 0.45, 0.2), scaling(0.3), translate(1.9, 0.3, 0.1))
    scene.mesh("vase", diffuse(0.55, 0.5, 0.45), scaling(0.85), translate(-2.6, 0.001, 0.2))
    scene.mesh("vase", GLASS, scaling(0.4), translate(2.1, 0.002, -0.9))
    scene.mesh("torus", MIRROR, rotate((1, 0, 0), 90), scaling(0.35), translate(-0.2, 0.42, -2.9))
    scene.mesh("torus", microfacet(0.2, (0.1, 0.4, 0.2)), scaling(0.5), translate(-1.6, 0.15, 0.3))
    scene.mesh("sphere_320", BLACK, scaling(0.18), translate(3.2, 2.2, -3), radiance=(28, 22, 14))
    scene.mesh("cube", wood, scaling(0.05, 2.02, 0.05), translate(3.175, -0.01, -3.025))
    scene.mesh("knot_light", BLACK, scaling(0.22), translate(-0.9, 2.6, -1.6), radiance=(9, 8, 12))
    return scene


def meshes():
    return {"cube": (box(), "Unit cube, 12 triangles, no vn"),
            "sphere_320": (icosphere(2), "Unit sphere, 320 triangles, smooth vn"),
            "sphere_1280": (icosphere(3), "Unit sphere, 1280 triangles, smooth vn"),
            "sphere_5120": (icosphere(4), "Unit sphere, 5120 triangles, smooth vn"),
            "torus": (torus(1, 0.28, 40, 20), "Torus about y, radii 1 and 0.28, 1600 triangles"),
            "knot": (torus_knot(3, 4, 1, 0.4, 0.13, 120, 10), "(3, 4) torus knot, 2400 triangles"),
            "vase": (vase(), "Vase, 2560 triangles"),
            "glass_ring": (band(0.62, 0.75, 0.45, 64), "Solid ring of rectangular section, 512 triangles"),
            "height_carpet": (height_field(1, 1, 40, 40, carpet), "Carpet, 3200 triangles"),
            "height_curtain": (height_field(1, 1, 20, 60, curtain), "Curtain, 2400 triangles"),
            "checker_dark": (checker(0), "Half of the squares of a checkered floor"),
            "checker_light": (checker(1), "The other half of the squares of a checkered floor")}


def scenes():
    ground = (0.55, 0.14, 0.1)
    phong_row = row("phong_lobes", """
Modified Phong (Lafortune and Willems 1994) with exponents 1, 10, 100 and 1000, from left to right.""",
                    [phong(ground, (0.7, 0.7, 0.7), 0.4, n) for n in (1, 10, 100, 1000)])
    microfacet_row = row("microfacet_alphas", """
Beckmann microfacets over a diffuse ground with alpha 0.01, 0.05, 0.1, 0.2 and 0.5, from left to right.""",
                         [microfacet(alpha, (0.08, 0.2, 0.35), 1.8) for alpha in (0.01, 0.05, 0.1, 0.2, 0.5)])
    return [phong_row, microfacet_row, caustic(), mixed_room(), spheres()]
