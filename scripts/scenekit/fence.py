"""A yard at dusk behind an iron fence: `mask` with a texture, and setts by a normal map. In the format of Mitsuba 3."""
import math

from scenekit.images import png, random_number
from scenekit.mitsuba import scene_text, view

FENCE = (128, 256)   # pixels of one bay: 1 wide, 2 high
SETTS = 192          # pixels of a square of ROWS rows of setts
ROWS, COLUMNS = 6, 4


def is_iron(x, y):
    """Does the bay have iron there? x in [0, 1], y in [0, 2] from the ground."""
    across = abs(x - 0.5)
    beside = min(x, 1 - x)  # from the middle between two pickets
    ring = lambda height, radius, width: abs(math.hypot(beside, y - height) - radius) < width
    return (across < 0.05 and y < 1.8                                      # a picket, ...
            or across < 0.11 * min(1, (1.97 - y) / 0.17, (y - 1.68) / 0.1)    # ... its spear head, ...
            or math.hypot(across, y - 0.95) < 0.085                        # ... its knot
            or abs(y - 0.16) < 0.035 or abs(y - 1.56) < 0.035 or abs(y - 1.16) < 0.025  # rails
            or ring(1.36, 0.165, 0.028) or ring(0.42, 0.2, 0.028)
            or beside < 0.03 and 0.64 < y < 1.16)


def opacity(px, py, samples=4):
    width, height = FENCE
    hits = sum(is_iron((px + (i + 0.5) / samples) / width, 2 * (1 - (py + (j + 0.5) / samples) / height))
               for j in range(samples) for i in range(samples))
    return (hits / samples**2,) * 3


def sett(u, v):
    """The stone at a point of the repeated unit square: (row, column), and its height there in rows; v goes down."""
    row = int(v * ROWS) % ROWS
    shifted = u * COLUMNS - 0.5 * (row % 2) - 0.12 * random_number(row, 7)
    column = math.floor(shifted) % COLUMNS
    x, y = 2 * (shifted - math.floor(shifted)) - 1, 2 * (v * ROWS - math.floor(v * ROWS)) - 1
    flat = abs(x) ** 6 + abs(y) ** 6                   # 1 in the joints
    dome = 0.16 * max(0, 1 - flat) ** 0.5 - 0.05 * (x * x + y * y)
    tilt = 0.05 * (random_number(row, column, 1) - 0.5) * x + 0.05 * (random_number(row, column, 2) - 0.5) * y
    grain = 0.006 * math.sin(37 * u * COLUMNS + 5 * row) * math.sin(31 * v * ROWS + 3 * column)
    return (row, column), (dome + tilt + grain if flat < 1 else -0.06), flat


def setts_normal(px, py):
    step = 1 / SETTS
    u, v = (px + 0.5) * step, (py + 0.5) * step
    height = lambda a, b: sett(a % 1, b % 1)[1] / ROWS  # in squares
    slope_u = (height(u + step / 2, v) - height(u - step / 2, v)) / step
    slope_v = (height(u, v + step / 2) - height(u, v - step / 2)) / step
    steepest = 1.2
    slope_u, slope_v = (max(-steepest, min(steepest, s)) for s in (slope_u, slope_v))
    length = math.sqrt(slope_u**2 + slope_v**2 + 1)
    normal = (-slope_u / length, -slope_v / length, 1 / length)
    return tuple(round((c + 1) / 2 * 85) / 85 for c in normal)


def setts_color(px, py):
    stone, _, flat = sett((px + 0.5) / SETTS, (py + 0.5) / SETTS)
    if flat >= 1:
        return (0.24, 0.23, 0.22)
    shade = round(5 * random_number(*stone, 3)) / 5
    return (0.45 + 0.16 * shade, 0.43 + 0.13 * shade, 0.42 + 0.1 * shade)


SCENE = view("-1.3, 1.55, 7.4", "0.1, 1.02, 0", 44, depth=12) + """
    <!-- The sky after sunset. -->
    <emitter type="constant">
        <rgb name="radiance" value="0.16, 0.22, 0.36"/>
    </emitter>

    <!-- Setts, whose normals are an image: 'raw', as they are no colours. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale value="12"/>
            <rotate x="1" angle="-90"/>
        </transform>
        <bsdf type="normalmap">
            <texture name="normalmap" type="bitmap">
                <string name="filename" value="textures/setts_normals.png"/>
                <boolean name="raw" value="true"/>
                <transform name="to_uv">
                    <scale value="10"/>
                </transform>
            </texture>
            <bsdf type="diffuse">
                <texture name="reflectance" type="bitmap">
                    <string name="filename" value="textures/setts.png"/>
                    <transform name="to_uv">
                        <scale value="10"/>
                    </transform>
                </texture>
            </bsdf>
        </bsdf>
    </shape>

    <!-- The fence: a rectangle, of which the image says where iron is. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="6" y="0.9"/>
            <translate y="0.92" z="2.2"/>
        </transform>
        <bsdf type="mask">
            <texture name="opacity" type="bitmap">
                <string name="filename" value="textures/fence.png"/>
                <boolean name="raw" value="true"/>
                <transform name="to_uv">
                    <scale x="13" y="-1"/>
                </transform>
            </texture>
            <bsdf type="twosided">
                <bsdf type="diffuse">
                    <rgb name="reflectance" value="0.035, 0.04, 0.042"/>
                </bsdf>
            </bsdf>
        </bsdf>
    </shape>

    <!-- A wall of the yard. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="12" y="2.2"/>
            <translate y="2.2" z="-4"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.5, 0.36, 0.27"/>
        </bsdf>
    </shape>

    <!-- In the yard: a star whose gilding is worn, which is a blend, on a plinth; glass and a mirror. -->
    <shape type="cube">
        <transform name="to_world">
            <scale x="0.55" y="0.4" z="0.55"/>
            <rotate y="1" angle="28"/>
            <translate x="0.1" y="0.4" z="-0.6"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.55, 0.53, 0.5"/>
        </bsdf>
    </shape>
    <shape type="ply">
        <string name="filename" value="meshes/star.ply"/>
        <boolean name="face_normals" value="true"/>
        <transform name="to_world">
            <scale value="0.78"/>
            <rotate z="1" angle="20.905"/>
            <rotate y="1" angle="20"/>
            <translate x="0.1" y="1.42" z="-0.6"/>
        </transform>
        <bsdf type="blendbsdf">
            <float name="weight" value="0.3"/>
            <bsdf type="diffuse">
                <rgb name="reflectance" value="0.85, 0.5, 0.12"/>
            </bsdf>
            <bsdf type="conductor"/>
        </bsdf>
    </shape>
    <shape type="sphere">
        <point name="center" x="-1.75" y="0.5" z="0.4"/>
        <float name="radius" value="0.5"/>
        <bsdf type="dielectric"/>
    </shape>
    <shape type="sphere">
        <point name="center" x="1.95" y="0.6" z="-0.1"/>
        <float name="radius" value="0.6"/>
        <bsdf type="conductor"/>
    </shape>

    <!-- Lanterns. -->
    <shape type="sphere">
        <point name="center" x="-2.6" y="2.3" z="-2.2"/>
        <float name="radius" value="0.24"/>
        <emitter type="area">
            <rgb name="radiance" value="42, 22, 8"/>
        </emitter>
    </shape>
    <shape type="sphere">
        <point name="center" x="2.9" y="2.0" z="-1.6"/>
        <float name="radius" value="0.2"/>
        <emitter type="area">
            <rgb name="radiance" value="42, 20, 7"/>
        </emitter>
    </shape>
    <shape type="sphere">
        <point name="center" x="-3.6" y="0.55" z="4.4"/>
        <float name="radius" value="0.16"/>
        <emitter type="area">
            <rgb name="radiance" value="36, 20, 9"/>
        </emitter>
    </shape>
"""


def files():
    return {"fence.xml": scene_text(
                "A yard at dusk behind a fence that a mask cuts out, in the format of Mitsuba 3: a blend, and a map of normals.", SCENE),
            "textures/fence.png": png(*FENCE, opacity),
            "textures/setts.png": png(SETTS, SETTS, setts_color),
            "textures/setts_normals.png": png(SETTS, SETTS, setts_normal)}
