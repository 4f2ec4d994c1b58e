"""The Cornell box from the measurements that Cornell's Program of Computer Graphics publishes
(https://www.graphics.cornell.edu/online/box/data.html): corners in the published unit (millimetres of the real box),
camera of focal length 0.035 and film 0.025 x 0.025. The spectra are used as the linear RGB triples that renderers have long
taken for them: white, red, green, and the lamp as 17 12 4, doubled here so that
the picture needs no exposure."""
import math

from scenekit.shapes import polygons
from scenekit.write import Scene, bsdf, diffuse, path_tracer, scaling, translate

WHITE, RED, GREEN, LAMP = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091), (34, 24, 8)

FLOOR = [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]
CEILING = [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)]
HOLE = [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]  # in the ceiling, filled by the lamp
BACK = [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]
RIGHT = [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]
LEFT = [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]
SHORT_TOP = [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)]
TALL_TOP = [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)]


def block(top):
    """The top and four sides down to the floor; the floor closes it."""
    down = lambda p: (p[0], 0, p[2])
    return polygons([top] + [[a, down(a), down(b), b] for a, b in zip(top, top[1:] + top[:1])])


def ceiling_with_hole():
    corner = lambda k: (CEILING[k % 4], HOLE[k % 4])
    return [[corner(k)[0], corner(k + 1)[0], corner(k + 1)[1], corner(k)[1]] for k in range(4)]


def meshes():
    return {"cbox_white": (polygons([FLOOR, BACK] + ceiling_with_hole()), "Cornell box: floor, back wall, ceiling with its hole"),
            "cbox_red": (polygons([LEFT]), "Cornell box: left wall"),
            "cbox_green": (polygons([RIGHT]), "Cornell box: right wall"),
            "cbox_short_block": (block(SHORT_TOP), "Cornell box: short block"),
            "cbox_tall_block": (block(TALL_TOP), "Cornell box: tall block")}


def cbox(variant, purpose, integrator, cosine=True, short="block", tall="block", spp=64):
    title = "The Cornell box from the published measurements (Cornell Program of Computer Graphics):\n"
    scene = Scene(f"cbox_{variant}", title + purpose, integrator, spp)
    scene.camera((278, 273, -800), (278, 273, 0), math.degrees(2 * math.atan(0.025 / 2 / 0.035)), 400, 400)
    white = diffuse(*WHITE, cosine)
    scene.mesh("cbox_white", white)
    scene.mesh("cbox_red", diffuse(*RED, cosine))
    scene.mesh("cbox_green", diffuse(*GREEN, cosine))
    if tall == "block":
        scene.mesh("cbox_tall_block", white)
    else:
        scene.mesh("sphere_5120", bsdf("mirror"), scaling(120), translate(395, 121, 320))
    if short == "block":
        scene.mesh("cbox_short_block", white)
    else:
        scene.mesh("sphere_5120", bsdf("dielectric"), scaling(90), translate(186, 91, 168.5))
    scene.parallelogram((213, 548.8, 227), (130, 0, 0), (0, 0, 105), diffuse(0.78, 0.78, 0.78, cosine), LAMP)
    return scene


def scenes():
    bsdf_only = path_tracer(nee=False, mis=False)
    return [
        cbox("uniform", "directions drawn uniformly over the hemisphere.", bsdf_only, cosine=False),
        cbox("cosine", "directions drawn in proportion to their cosine.", bsdf_only),
        cbox("nee", "next-event estimation.", path_tracer(mis=False)),
        cbox("mis", "next-event estimation and BSDF sampling by multiple importance sampling.", path_tracer()),
        cbox("mirror", "a mirror sphere in place of the tall block.", path_tracer(), tall="sphere"),
        cbox("dielectric", "a glass sphere in place of the short block; its caustic is the noise that stays.", path_tracer(),
             short="sphere", spp=256),
    ]
