"""Scenes in the format of Mitsuba 3, and their PLY mesh."""
import math

from scenekit import sky
from scenekit.shapes import polygons
from scenekit.vec import add, cross, dot, norm, scale, sub
from scenekit.write import LICENCE, number


def stellated_dodecahedron():
    """The small stellated dodecahedron, tips on the unit sphere: a pyramid on each pentagon, whose sides go on in the planes of
    the pentagons around it. Its height is the golden ratio times the radius of the corners around the pentagon's middle."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for a in (-1, 1):
        for b in (-1, 1):
            corners += [(0, a / g, b * g), (a / g, b * g, 0), (b * g, 0, a / g)]
    tips = [norm(p) for a in (-1, 1) for b in (-1, 1) for p in [(0, a * g, b), (a * g, b, 0), (b, 0, a * g)]]
    triangles = []
    for tip in tips:
        side = sorted(corners, key=lambda p: -dot(p, tip))[:5]
        middle = scale(tip, dot(side[0], tip))
        u = norm(sub(side[0], middle))
        v = cross(tip, u)
        side.sort(key=lambda p: math.atan2(dot(sub(p, middle), v), dot(sub(p, middle), u)))
        height = g * math.dist(side[0], middle)
        top = add(middle, scale(tip, height))
        size = math.sqrt(dot(top, top))
        triangles += [[scale(p, 1 / size) for p in (side[k], side[(k + 1) % 5], top)] for k in range(5)]
    return polygons([[tuple(round(x, 5) for x in p) for p in triangle] for triangle in triangles])


def ply_text(surface, comment):
    lines = ["ply", "format ascii 1.0", f"comment {comment}", f"comment {LICENCE}",
             f"element vertex {len(surface.positions)}", "property float x", "property float y", "property float z",
             f"element face {len(surface.faces)}", "property list uchar int vertex_indices", "end_header"]
    lines += [" ".join(number(round(x, 5)) for x in p) for p in surface.positions]
    lines += [" ".join(str(n) for n in [len(face), *(i for i, _ in face)]) for face in surface.faces]
    return "\n".join(lines) + "\n"


def view(origin, target, fov, depth=16, sampler="multijitter", spp=64, width=480, height=360):
    """The integrator and the sensor of a scene; depth: most segments of a path."""
    return f"""
    <integrator type="path">
        <integer name="max_depth" value="{depth}"/>
    </integrator>

    <sensor type="perspective">
        <float name="fov" value="{fov}"/>
        <transform name="to_world">
            <lookat origin="{origin}" target="{target}" up="0, 1, 0"/>
        </transform>
        <film type="hdrfilm">
            <integer name="width" value="{width}"/>
            <integer name="height" value="{height}"/>
        </film>
        <sampler type="{sampler}">
            <integer name="sample_count" value="{spp}"/>
        </sampler>
    </sensor>
"""


SHAPES = view("0.6, 3, 9.2", "0.05, 0.85, 0", 41.5) + """
    <bsdf type="twosided" id="plaster">
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.62, 0.6, 0.57"/>
        </bsdf>
    </bsdf>
    <bsdf type="dielectric" id="glass">
        <string name="int_ior" value="bk7"/>
        <string name="ext_ior" value="air"/>
    </bsdf>

    <!-- The floor, a wall, a mirror that leans against it: rectangles. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale value="9"/>
            <rotate x="1" angle="-90"/>
        </transform>
        <ref id="plaster"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="9" y="4"/>
            <translate y="4" z="-3.2"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.22, 0.34, 0.42"/>
        </bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="1.5" y="1.3"/>
            <rotate x="1" angle="-12"/>
            <translate x="0.2" y="1.3" z="-2.7"/>
        </transform>
        <bsdf type="conductor"/>
    </shape>

    <!-- Behind the camera, for the mirror and the glass. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="9" y="4"/>
            <rotate y="1" angle="180"/>
            <translate y="4" z="9.5"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.8, 0.62, 0.45"/>
        </bsdf>
    </shape>

    <!-- An OBJ file with normals of its own. -->
    <shape type="obj">
        <string name="filename" value="meshes/knot.obj"/>
        <transform name="to_world">
            <scale value="0.72"/>
            <rotate x="1" angle="78"/>
            <rotate y="1" angle="-25"/>
            <translate x="-2.35" y="1.15" z="0.1"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.75, 0.28, 0.12"/>
        </bsdf>
    </shape>

    <!-- A PLY file; face_normals keeps its edges sharp. -->
    <shape type="ply">
        <string name="filename" value="meshes/star.ply"/>
        <boolean name="face_normals" value="true"/>
        <transform name="to_world">
            <scale value="0.95"/>
            <rotate z="1" angle="20.905"/>
            <rotate y="1" angle="35"/>
            <translate x="2.3" y="0.755" z="0.3"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.85, 0.62, 0.14"/>
        </bsdf>
    </shape>

    <!-- Exact spheres: one of glass, one that is no more than its mask lets be seen. -->
    <shape type="sphere">
        <point name="center" x="-0.15" y="0.75" z="1.5"/>
        <float name="radius" value="0.75"/>
        <ref id="glass"/>
    </shape>
    <shape type="sphere">
        <transform name="to_world">
            <scale value="0.34"/>
            <translate x="1.25" y="0.34" z="2.2"/>
        </transform>
        <bsdf type="mask">
            <float name="opacity" value="0.6"/>
            <bsdf type="twosided">
                <bsdf type="diffuse">
                    <rgb name="reflectance" value="0.15, 0.5, 0.3"/>
                </bsdf>
            </bsdf>
        </bsdf>
    </shape>

    <!-- A cube. -->
    <shape type="cube">
        <transform name="to_world">
            <scale value="0.5"/>
            <rotate y="1" angle="28"/>
            <translate x="-1.7" y="0.5" z="2.3"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.3, 0.32, 0.62"/>
        </bsdf>
    </shape>

    <!-- The lamp: a rectangle that looks down. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="2.6" y="1.8"/>
            <rotate x="1" angle="90"/>
            <translate x="-0.8" y="6" z="2.4"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0"/>
        </bsdf>
        <emitter type="area">
            <rgb name="radiance" value="7.5, 7, 6.2"/>
        </emitter>
    </shape>
"""

SKY = view("3.9, 2.6, 8.4", "0.25, 1.3, 0", 32, depth=12, sampler="independent") + """
    <emitter type="constant">
        <rgb name="radiance" value="0.62, 0.83, 1.15"/>
    </emitter>

    <shape type="rectangle">
        <transform name="to_world">
            <scale value="60"/>
            <rotate x="1" angle="-90"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.55, 0.5, 0.4"/>
        </bsdf>
    </shape>

    <shape type="obj">
        <string name="filename" value="meshes/knot.obj"/>
        <transform name="to_world">
            <rotate x="1" angle="82"/>
            <rotate y="1" angle="24"/>
            <translate x="-0.35" y="1.58" z="-0.5"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.82, 0.5, 0.2"/>
        </bsdf>
    </shape>

    <shape type="obj">
        <string name="filename" value="meshes/vase.obj"/>
        <transform name="to_world">
            <scale value="0.62"/>
            <translate x="1.55" z="0.75"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.66, 0.27, 0.15"/>
        </bsdf>
    </shape>

    <shape type="obj">
        <string name="filename" value="meshes/torus.obj"/>
        <transform name="to_world">
            <scale value="0.42"/>
            <translate x="0.45" y="0.1176" z="1.35"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.2, 0.42, 0.5"/>
        </bsdf>
    </shape>
"""


SKY_MAP = view("3.3, 1.5, 8.2", "0.1, 1.45, 0", 34, sampler="independent") + """
    <!-- The first row of the map is up, +y. -->
    <emitter type="envmap">
        <string name="filename" value="textures/evening_sky.exr"/>
        <float name="scale" value="1.2"/>
    </emitter>

    <shape type="rectangle">
        <transform name="to_world">
            <scale value="300"/>
            <rotate x="1" angle="-90"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.42, 0.38, 0.32"/>
        </bsdf>
    </shape>

    <shape type="obj">
        <string name="filename" value="meshes/knot.obj"/>
        <transform name="to_world">
            <rotate x="1" angle="82"/>
            <rotate y="1" angle="24"/>
            <translate x="-0.55" y="1.58" z="-0.4"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.78, 0.74, 0.68"/>
        </bsdf>
    </shape>

    <shape type="sphere">
        <float name="radius" value="0.62"/>
        <point name="center" value="1.75, 0.62, 0.7"/>
        <bsdf type="conductor"/>
    </shape>

    <shape type="obj">
        <string name="filename" value="meshes/torus.obj"/>
        <transform name="to_world">
            <scale value="0.42"/>
            <translate x="0.45" y="0.1176" z="1.9"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.12, 0.32, 0.36"/>
        </bsdf>
    </shape>

    <shape type="obj">
        <string name="filename" value="meshes/vase.obj"/>
        <transform name="to_world">
            <scale value="0.5"/>
            <translate x="-1.5" z="1.35"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.5, 0.16, 0.08"/>
        </bsdf>
    </shape>
"""


PREVIEW = """
    <default name="material" value="copper"/>
""" + view("0, 2.3, 6.4", "0, 0.98, 0", 26, spp=256, width=384, height=384) + """
    <!-- The sky, and a window for highlights. -->
    <emitter type="constant">
        <rgb name="radiance" value="0.35, 0.42, 0.52"/>
    </emitter>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="1.3" y="1.3"/>
            <lookat origin="-3.2, 4.6, 3.4" target="0, 1, 0" up="0, 1, 0"/>
        </transform>
        <emitter type="area">
            <rgb name="radiance" value="14, 13, 11.5"/>
        </emitter>
    </shape>

    <!-- The ground and the plinth. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale value="14"/>
            <rotate x="1" angle="-90"/>
        </transform>
        <bsdf type="diffuse">
            <texture name="reflectance" type="checkerboard">
                <rgb name="color0" value="0.32, 0.32, 0.33"/>
                <rgb name="color1" value="0.2, 0.2, 0.21"/>
                <transform name="to_uv">
                    <scale x="20" y="20"/>
                </transform>
            </texture>
        </bsdf>
    </shape>
    <shape type="cube">
        <transform name="to_world">
            <scale x="0.62" y="0.14" z="0.62"/>
            <rotate y="1" angle="32"/>
            <translate y="0.14"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.6, 0.58, 0.54"/>
        </bsdf>
    </shape>

    <!-- The sphere, its axis upright. -->
    <shape type="sphere">
        <transform name="to_world">
            <scale value="0.86"/>
            <rotate x="1" angle="-90"/>
            <translate y="1.14"/>
        </transform>
        <ref id="$material"/>
    </shape>

    <!-- The materials. -->
    <bsdf type="diffuse" id="clay">
        <rgb name="reflectance" value="0.58, 0.34, 0.22"/>
    </bsdf>
    <bsdf type="conductor" id="gold">
        <string name="material" value="Au"/>
    </bsdf>
    <bsdf type="roughconductor" id="copper">
        <string name="material" value="Cu"/>
        <string name="distribution" value="ggx"/>
        <float name="alpha" value="0.2"/>
    </bsdf>
    <bsdf type="roughconductor" id="brushed_aluminium">
        <string name="material" value="Al"/>
        <string name="distribution" value="ggx"/>
        <float name="alpha_u" value="0.05"/>
        <float name="alpha_v" value="0.35"/>
    </bsdf>
    <bsdf type="dielectric" id="glass"/>
    <bsdf type="dielectric" id="tinted_glass">
        <rgb name="specular_transmittance" value="0.5, 0.85, 0.7"/>
    </bsdf>
    <bsdf type="thindielectric" id="bubble"/>
    <bsdf type="roughdielectric" id="frosted_glass">
        <string name="distribution" value="ggx"/>
        <float name="alpha" value="0.25"/>
    </bsdf>
    <bsdf type="roughdielectric" id="ground_glass">
        <float name="alpha" value="0.5"/>
    </bsdf>
    <bsdf type="plastic" id="billiard_ball">
        <rgb name="diffuse_reflectance" value="0.5, 0.03, 0.02"/>
        <boolean name="nonlinear" value="true"/>
    </bsdf>
    <bsdf type="roughplastic" id="satin_plastic">
        <rgb name="diffuse_reflectance" value="0.06, 0.24, 0.36"/>
        <float name="alpha" value="0.15"/>
    </bsdf>
    <bsdf type="principled" id="car_paint">
        <rgb name="base_color" value="0.35, 0.02, 0.03"/>
        <float name="metallic" value="0.6"/>
        <float name="roughness" value="0.45"/>
        <float name="clearcoat" value="1"/>
        <float name="clearcoat_gloss" value="0.95"/>
    </bsdf>
    <bsdf type="principled" id="velvet">
        <rgb name="base_color" value="0.16, 0.05, 0.22"/>
        <float name="roughness" value="0.9"/>
        <float name="spec_tint" value="1"/>
        <float name="sheen" value="1"/>
        <float name="sheen_tint" value="0.6"/>
    </bsdf>
    <bsdf type="principledthin" id="paper_lantern">
        <rgb name="base_color" value="0.85, 0.72, 0.5"/>
        <float name="roughness" value="0.6"/>
        <float name="diff_trans" value="1.2"/>
    </bsdf>
    <bsdf type="blendbsdf" id="inlay">
        <texture name="weight" type="checkerboard">
            <float name="color0" value="0"/>
            <float name="color1" value="1"/>
            <transform name="to_uv">
                <scale x="14" y="7"/>
            </transform>
        </texture>
        <bsdf type="roughconductor">
            <string name="material" value="Cr"/>
            <float name="alpha" value="0.15"/>
        </bsdf>
        <bsdf type="plastic">
            <rgb name="diffuse_reflectance" value="0.05, 0.16, 0.09"/>
        </bsdf>
    </bsdf>
"""


def scene_text(comment, body):
    return f'<?xml version="1.0"?>\n<!-- {comment}\n     {LICENCE} -->\n<scene version="3.0.0">{body}</scene>\n'


def files():
    """{path in scenes/: text or bytes}"""
    return {
        "meshes/star.ply": ply_text(stellated_dodecahedron(), "A small stellated dodecahedron, 60 triangles."),
        "mitsuba_shapes.xml": scene_text(
            "A file of Mitsuba 3 with each shape, obj, ply, sphere, rectangle and cube, and each material, under an area light.", SHAPES),
        "constant_sky.xml": scene_text(
            "Diffuse things under a sky of one radiance, in the format of Mitsuba 3: all shadows are soft.", SKY),
        "textures/evening_sky.exr": sky.environment_map(),
        "sky_over_model.xml": scene_text(
            "Diffuse things and a mirror under an evening sky that is an image, in the format of Mitsuba 3.", SKY_MAP),
        "preview.xml": scene_text(
            "A material on a sphere on a plinth, in the format of Mitsuba 3; -D material=gold picks another one of those at the end.",
            PREVIEW),
    }
