"""Scenes about the eta correction of Russian roulette (scenes/eta_study/README.md): where it must matter, and where it may not."""
import math

from scenekit.lights import BLACK, room
from scenekit.shapes import polygons
from scenekit.write import Scene, bsdf, diffuse, real, rotate, scaling, translate

FOLDER = "eta_study/"
WHITE = diffuse(0.7, 0.68, 0.65)


def glass(n):
    return bsdf("dielectric", real("intIOR", n), real("extIOR", 1))


def brilliant():
    """A cut gem about the y axis: octagonal table, crown and pavilion, flat facets, 30 triangles."""
    ring = lambda r, y: [(r * math.cos(math.pi * k / 4), y, -r * math.sin(math.pi * k / 4)) for k in range(8)]
    table, girdle, tip = ring(0.55, 0.32), ring(1, 0), (0, -0.86, 0)
    crown = [[girdle[k], girdle[(k + 1) % 8], table[(k + 1) % 8], table[k]] for k in range(8)]
    return polygons([table] + crown + [[girdle[(k + 1) % 8], girdle[k], tip] for k in range(8)])


def bright_room(name, purpose, front=True):
    """A room under a wide lamp, with or without its front wall."""
    scene = Scene(FOLDER + name, purpose)
    room(scene, (-3, 0, -2.5), (3, 4, 5.5), diffuse(0.6, 0.3, 0.25), diffuse(0.25, 0.4, 0.6), WHITE)
    if front:
        scene.quad((3, 0, 5.5), (-3, 0, 5.5), (3, 4, 5.5), WHITE)
    scene.parallelogram((-2, 3.98, -1), (4, 0, 0), (0, 0, 4), BLACK, (2.2, 2.1, 1.9))
    return scene


def furnished(scene):
    scene.mesh("cube", WHITE, scaling(1.2, 2, 1.2), rotate((0, 1, 0), 25), translate(-1.8, 0, -0.6))
    scene.mesh("cube", WHITE, scaling(1.2, 1, 1.2), rotate((0, 1, 0), -20), translate(0.4, 0, 1))
    return scene


def pane():
    scene = furnished(bright_room("pane", """
A room whose open front is closed by a pane of index 2.4: every path enters the pane and leaves it before it meets the room.""", front=False))
    scene.camera((0, 2, 12.5), (0, 2, 0), 34, 480, 360)
    scene.mesh("cube", glass(2.4), scaling(6, 4, 0.3), translate(-3, 0, 5.51))
    return scene


def inside():
    scene = furnished(bright_room("inside", "A room seen from within a ball of index 2.4: every path leaves the glass first."))
    scene.camera((0, 2, 4.9), (0, 1.6, 0), 60, 480, 360)
    scene.mesh("sphere_5120", glass(2.4), scaling(0.4), translate(0, 2, 4.9))
    return scene


def diamonds():
    scene = bright_room("diamonds", "Five cut diamonds (index 2.42) in a bright room: paths are reflected inside a stone some times, leave it, and meet others.")
    scene.camera((0, 2.3, 4.6), (0, 0.75, 0), 42, 480, 360)
    for k, (x, y, z) in enumerate([(-1.25, 0.9, 0.4), (0, 0.9, 0.9), (1.25, 0.9, 0.4), (-0.65, 1.05, -0.9), (0.65, 1.05, -0.9)]):
        scene.mesh("brilliant", glass(2.42), scaling(0.62), rotate((1, 0, 0), 20 + 9 * k), rotate((0, 1, 0), 37 * k), translate(x, y, z))
    return scene


def pond():
    scene = bright_room("pond", """
A pond of index 2.4 with a bed that reflects 2 % in a bright room: what enters the glass finds little, so that to end it there is right.""")
    scene.camera((0, 2.6, 5), (0, 0.6, -0.5), 46, 480, 360)
    scene.parallelogram((-2.9, 0.02, 5.4), (5.8, 0, 0), (0, 0, -7.8), diffuse(0.02, 0.02, 0.02))
    scene.mesh("cube", glass(2.4), scaling(5.8, 0.4, 7.8), translate(-2.9, 0.04, -2.4))
    return scene


def meshes():
    return {"brilliant": (brilliant(), "Cut gem, 30 triangles, no vn")}


def scenes():
    return [pane(), inside(), diamonds(), pond()]
