"""Scenes with textures, in the format of Mitsuba 3: a room, and a lamp of stained glass. Their images, and their mesh with
texture coordinates."""
import math

from scenekit.images import mix, noise, png, random_number
from scenekit.mitsuba import scene_text, view
from scenekit.shapes import Surface, lathe
from scenekit.vec import norm
from scenekit.write import obj_text


def planks(x, y):
    """Oak boards along x, four to the image's height: 256 x 128 pixels that repeat."""
    row = y // 32
    along = (x + 256 * random_number(row, 1)) % 256
    if y % 32 < 1 or along < 1.5:
        return 0.23, 0.14, 0.08
    tone = random_number(row, 2)
    rings = noise(along / 42 + 9 * tone, (y % 32) / 3.2, 64, 64, row)
    grain = 0.5 + 0.5 * math.sin(2 * math.pi * (y / 7 + 2.6 * rings))
    fibre = random_number(x // 6, y, 3)
    color = mix((0.62, 0.42, 0.25), (0.76, 0.56, 0.36), 0.25 + 0.5 * grain)
    shade = 0.85 + 0.2 * tone - 0.06 * fibre
    return tuple(round(24 * c * shade) / 24 for c in color)  # few colours, for a small file


def wallpaper(x, y):
    """Leaves on stems, 64 x 64 pixels that repeat."""
    ground, stem, leaf, flower = (0.80, 0.78, 0.68), (0.48, 0.55, 0.42), (0.42, 0.56, 0.48), (0.78, 0.45, 0.36)
    color = ground
    sway = 32 + 9 * math.sin(2 * math.pi * y / 64)
    if abs(x - sway) < 1.2:
        color = stem
    for k in range(4):
        side = 1 if k % 2 else -1
        cy = 8 + 16 * k
        cx = 32 + 9 * math.sin(2 * math.pi * cy / 64) + 9 * side
        dx, dy = (x - cx) * side, (y - cy + 32) % 64 - 32
        u, v = 0.8 * dx - 0.6 * dy, 0.6 * dx + 0.8 * dy
        if (u / 9) ** 2 + (v / 3.6) ** 2 < 1:
            color = leaf if abs(v) > 0.7 else stem
    for cx, cy in ((2, 32), (62, 32), (66, 32), (-2, 32), (32, 0), (32, 64)):
        if math.hypot(x - cx, y - cy) < (4.4 if cx != 32 else 0):
            color = flower
    if abs(math.hypot(min(x, 64 - x), y - 32) - 7.5) < 0.8:
        color = flower
    return color


def rug(x, y):
    """A woven rug, 96 x 144 pixels."""
    red, blue, cream, gold = (0.52, 0.12, 0.12), (0.13, 0.19, 0.36), (0.82, 0.76, 0.62), (0.72, 0.53, 0.22)
    edge = min(x, y, 95 - x, 143 - y)
    a, b = abs(x - 47.5), abs(y - 71.5)
    if edge < 3:
        color = cream
    elif edge < 12:
        color = blue if (x // 4 + y // 4) % 2 else gold
    elif edge < 14:
        color = cream
    else:
        ring = a / 34 + b / 58
        waves = math.floor(7 * ring)
        color = (red, blue, red, gold, red, cream, red)[waves % 7] if ring < 1 else mix(red, blue, 0.35)
        if ring >= 1 and (int(a) // 3 + int(b) // 3) % 4 == 0:
            color = gold
    weave = 0.94 if (x + y) % 2 else 1.0
    return tuple(c * weave for c in color)


def painting(x, y):
    """Hills in the evening, 120 x 80 pixels."""
    height = 1 - y / 80
    color = mix((0.98, 0.72, 0.40), (0.28, 0.36, 0.60), max(0, (height - 0.35) / 0.65) ** 0.8)
    if math.hypot(x - 82, y - 36) < 8:
        color = (1.0, 0.93, 0.72)
    for k, (base, size, tint) in enumerate([(0.52, 0.16, (0.52, 0.40, 0.52)), (0.38, 0.15, (0.36, 0.33, 0.44)),
                                             (0.22, 0.17, (0.20, 0.25, 0.26))]):
        ridge = base + size * (noise(x / (26 - 5 * k), 0.5, 99, 1, 20 + k) - 0.5)
        if height < ridge:
            color = mix(tint, (0.9, 0.6, 0.45), 0.25 * max(0, 1 - (ridge - height) / 0.1) * (k < 2))
    return tuple(round(40 * c) / 40 for c in color)


def globe(x, y):
    """A globe, 192 x 96 pixels: land, sea, ice, and lines each 30 degrees."""
    longitude, polar = 2 * math.pi * (x + 0.5) / 192, math.pi * (y + 0.5) / 96
    p = (math.sin(polar) * math.cos(longitude), math.sin(polar) * math.sin(longitude), math.cos(polar))
    land = sum((noise(1.3 * f * (p[0] + 0.6 * p[2]) + 40, 1.3 * f * (p[1] - 0.5 * p[2]) + 40, 97, 89, 31 + f) +
                noise(1.3 * f * (p[2] + 0.4 * p[0]) + 40, 1.3 * f * (p[1] + 0.7 * p[0]) + 40, 97, 89, 51 + f)) / (2 * f)
               for f in (1, 2, 4))
    if x % 16 == 0 or y % 16 == 0:
        return 0.25, 0.25, 0.22
    if abs(p[2]) > 0.93:
        return 0.92, 0.93, 0.92
    if land < 0.9:
        return mix((0.15, 0.33, 0.47), (0.26, 0.49, 0.57), round(4 * min(1, max(0, land - 0.5) / 0.4)) / 4)
    return mix((0.55, 0.62, 0.36), (0.70, 0.58, 0.36), round(5 * min(1, (land - 0.9) / 0.3)) / 5)


GLASS_COLORS = [(0.82, 0.16, 0.10), (0.94, 0.52, 0.10), (0.98, 0.80, 0.30), (0.22, 0.52, 0.24), (0.10, 0.34, 0.62),
                (0.44, 0.20, 0.52)]


def bell(s):
    """Radius and height of the lampshade at the share s of its way down."""
    return 0.16 + 0.84 * math.sin(0.5 * math.pi * s) ** 0.8, 0.7 * max(0, math.cos(0.5 * math.pi * s)) ** 0.9


def stained_glass(x, y):
    """Panes of a lampshade between strips of lead, 640 x 128 pixels, which repeat along x. The top row is the shade's top.
    Rays, eight flowers before a ground of tiles, a hem. Lengths are those on the shade."""
    u, v = (x + 0.5) / 640, (y + 0.5) / 128
    around = 2 * math.pi * bell(v)[0]
    lead, strip = (0.02, 0.02, 0.02), 0.011

    def pane(color, *key):
        tone = (0.8 + 0.4 * random_number(*key)) * (0.92 + 0.16 * noise(x / 9, y / 9, 71, 15, 5))
        return tuple(round(20 * c * tone) / 20 for c in GLASS_COLORS[color])

    def tiles(many, shift=0.0):
        """The tile of a row of `many`, None on the lead between them."""
        cell = many * u + shift
        return None if min(cell % 1, 1 - cell % 1) * around / many < strip else int(cell) % many

    if v > 0.9:
        tile = tiles(48)
        return lead if v < 0.917 or v > 0.985 or tile is None else pane(4 if tile % 2 else 0, tile, 1)
    if v < 0.27:
        tile = tiles(24)
        return lead if v < 0.04 or v > 0.255 or tile is None else pane(2, tile, 4)
    flower = int(8 * u)
    across, down = (8 * u % 1 - 0.5) / 8 * around, 1.2 * (v - 0.6)
    radius, angle = math.hypot(across, down), math.atan2(down, across) + math.pi / 2
    petals = 0.215 + 0.06 * math.cos(5 * angle)
    if radius < 0.08:
        return lead if radius > 0.065 else pane(2, flower, 2)
    if radius < petals:
        cut = 5 * angle / (2 * math.pi) + 0.5
        on_lead = petals - radius < 1.5 * strip or min(cut % 1, 1 - cut % 1) * radius * 1.2 < strip
        return lead if on_lead else pane((0, 5, 1, 5)[flower % 4], flower, int(cut), 3)
    row = int(7 * v)
    tile = tiles(40, 0.5 * (row % 2))
    if tile is None or min(7 * v % 1, 1 - 7 * v % 1) * 1.2 / 7 < strip:
        return lead
    return pane(3 if v < 0.5 else 4, tile, row)


def with_uv(rows, columns, point, normal):
    """Quads over point(s, t), 0 <= s, t <= 1, with smooth normals, and texture coordinates (t, 1 - s): s runs down."""
    surface = Surface([], [], [])
    for i in range(rows + 1):
        for j in range(columns + 1):
            s, t = i / rows, j / columns
            surface.positions.append(point(s, t))
            surface.normals.append(norm(normal(s, t)))
            surface.uvs.append((t, 1 - s))
    at = lambda i, j: (i * (columns + 1) + j,) * 3
    surface.faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(rows) for j in range(columns)]
    return surface


def lampshade():
    """A bell about the y axis, open at both ends, of height 0.7 and lower radius 1; its front is outside. u runs around."""
    def point(s, t):
        a, (r, y) = 2 * math.pi * t, bell(s)
        return r * math.cos(a), y, -r * math.sin(a)

    def normal(s, t):
        a, h = 2 * math.pi * t, 1e-3
        (r0, y0), (r1, y1) = bell(max(0, s - h)), bell(min(1, s + h))
        return (y0 - y1) * math.cos(a), r1 - r0, -(y0 - y1) * math.sin(a)

    return with_uv(24, 96, point, normal)


def lamp_foot():
    """A foot that stands on y = 0, and a stem up to 1.9."""
    profile = lambda s: (0.03 + 0.36 * max(0, 1 - 4 * s) ** 1.6 + 0.06 * math.exp(-((s - 0.42) / 0.12) ** 2), 1.9 * s)
    return lathe(profile, 40, 32)


def bitmap(name, file, *properties, kind="bitmap"):
    lines = "".join(f"\n            {line}" for line in (f'<string name="filename" value="textures/{file}.png"/>', *properties))
    return f"""<texture type="{kind}" name="{name}">{lines}
        </texture>"""


TEXTURED_ROOM = view("-0.3, 2.1, 6.1", "0.1, 1.35, 0", 46) + f"""
    <!-- The floor: boards that repeat. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="3.5" y="3"/>
            <rotate x="1" angle="-90"/>
        </transform>
        <bsdf type="diffuse">
            {bitmap("reflectance", "planks", '<transform name="to_uv">', '    <scale x="2.6" y="4.4"/>', '</transform>')}
        </bsdf>
    </shape>

    <!-- The walls: paper on two of them, and the ceiling. -->
    <bsdf type="diffuse" id="paper">
        {bitmap("reflectance", "wallpaper", '<transform name="to_uv">', '    <scale x="9" y="4.5"/>', '</transform>')}
    </bsdf>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="3.5" y="1.75"/>
            <translate y="1.75" z="-3"/>
        </transform>
        <ref id="paper"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="3" y="1.75"/>
            <rotate y="1" angle="-90"/>
            <translate x="3.5" y="1.75"/>
        </transform>
        <ref id="paper"/>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="3.5" y="3"/>
            <rotate x="1" angle="90"/>
            <translate y="3.5"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.72, 0.7, 0.66"/>
        </bsdf>
    </shape>

    <!-- A rug, and a picture in its frame. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="1.15" y="1.7"/>
            <rotate x="1" angle="-90"/>
            <rotate y="1" angle="70"/>
            <translate x="-0.1" y="0.01" z="0.6"/>
        </transform>
        <bsdf type="diffuse">
            {bitmap("reflectance", "rug", '<string name="filter_type" value="nearest"/>')}
        </bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="0.9" y="0.6"/>
            <translate x="-0.55" y="2.05" z="-2.94"/>
        </transform>
        <bsdf type="diffuse">
            {bitmap("reflectance", "painting", '<transform name="to_uv">', '    <scale x="1" y="-1"/>', '</transform>')}
        </bsdf>
    </shape>
    <shape type="cube">
        <transform name="to_world">
            <scale x="1" y="0.7" z="0.03"/>
            <translate x="-0.55" y="2.05" z="-2.98"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.3, 0.2, 0.1"/>
        </bsdf>
    </shape>

    <!-- A chest of checkered wood, and on it a globe. -->
    <shape type="cube">
        <transform name="to_world">
            <scale x="0.62" y="0.5" z="0.45"/>
            <rotate y="1" angle="-24"/>
            <translate x="1.95" y="0.5" z="-1.3"/>
        </transform>
        <bsdf type="diffuse">
            <texture type="checkerboard" name="reflectance">
                <rgb name="color0" value="0.42, 0.25, 0.13"/>
                <rgb name="color1" value="0.16, 0.09, 0.05"/>
                <transform name="to_uv">
                    <scale value="3"/>
                </transform>
            </texture>
        </bsdf>
    </shape>
    <shape type="sphere">
        <float name="radius" value="0.46"/>
        <transform name="to_world">
            <rotate z="1" angle="200"/>
            <rotate x="1" angle="-90"/>
            <rotate z="1" angle="-23"/>
            <translate x="1.95" y="1.46" z="-1.3"/>
        </transform>
        <bsdf type="diffuse">
            {bitmap("reflectance", "globe")}
        </bsdf>
    </shape>

    <!-- A vase and a ball of glass. -->
    <shape type="obj">
        <string name="filename" value="meshes/vase.obj"/>
        <transform name="to_world">
            <scale value="0.75"/>
            <translate x="-2.2" z="-1.6"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.25, 0.4, 0.45"/>
        </bsdf>
    </shape>
    <shape type="sphere">
        <point name="center" x="-1.15" y="0.36" z="0.9"/>
        <float name="radius" value="0.35"/>
        <bsdf type="dielectric"/>
    </shape>

    <!-- The window on the left. -->
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="1.3" y="1.1"/>
            <rotate y="1" angle="90"/>
            <translate x="-3.5" y="2" z="0.6"/>
        </transform>
        <emitter type="area">
            <rgb name="radiance" value="13, 12.4, 11"/>
        </emitter>
    </shape>
"""

STAINED_GLASS = view("0, 2.35, 6.4", "0, 1.08, 0.1", 33) + f"""
    <!-- The shade: its glass shines as the texture says, outside and in. -->
    <bsdf type="diffuse" id="black">
        <rgb name="reflectance" value="0"/>
    </bsdf>
    <shape type="obj" id="shade">
        <string name="filename" value="meshes/lampshade.obj"/>
        <transform name="to_world">
            <rotate y="1" angle="8"/>
            <translate y="1.45"/>
        </transform>
        <ref id="black"/>
        <emitter type="area">
            {bitmap("radiance", "stained_glass")}
        </emitter>
    </shape>

    <!-- The bulb under it, the foot, the table and the wall. -->
    <shape type="sphere">
        <point name="center" x="0" y="1.72" z="0"/>
        <float name="radius" value="0.12"/>
        <emitter type="area">
            <rgb name="radiance" value="70, 54, 32"/>
        </emitter>
    </shape>
    <shape type="obj">
        <string name="filename" value="meshes/lamp_foot.obj"/>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.32, 0.22, 0.1"/>
        </bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="2.6" y="1.6"/>
            <rotate x="1" angle="-90"/>
        </transform>
        <bsdf type="diffuse">
            {bitmap("reflectance", "planks", '<transform name="to_uv">', '    <scale x="1.6" y="2"/>', '</transform>')}
        </bsdf>
    </shape>
    <shape type="rectangle">
        <transform name="to_world">
            <scale x="6" y="4"/>
            <translate y="2" z="-1.25"/>
        </transform>
        <bsdf type="diffuse">
            <rgb name="reflectance" value="0.7, 0.68, 0.62"/>
        </bsdf>
    </shape>

    <!-- Things in its light. -->
    <shape type="sphere">
        <point name="center" x="-1.05" y="0.28" z="0.75"/>
        <float name="radius" value="0.28"/>
        <bsdf type="dielectric"/>
    </shape>
    <shape type="obj">
        <string name="filename" value="meshes/torus.obj"/>
        <transform name="to_world">
            <scale value="0.26"/>
            <translate x="0.95" y="0.073" z="0.85"/>
        </transform>
        <bsdf type="conductor"/>
    </shape>
"""


def files():
    """{path in scenes/: text or bytes}"""
    return {
        "textures/planks.png": png(256, 128, planks),
        "textures/wallpaper.png": png(64, 64, wallpaper),
        "textures/rug.png": png(96, 144, rug),
        "textures/painting.png": png(120, 80, painting),
        "textures/globe.png": png(192, 96, globe),
        "textures/stained_glass.png": png(640, 128, stained_glass),
        "meshes/lampshade.obj": obj_text(lampshade(), "A lampshade with texture coordinates, 4608 triangles."),
        "meshes/lamp_foot.obj": obj_text(lamp_foot(), "The foot of a lamp."),
        "textured_room.xml": scene_text(
            "A room whose floor, walls, rug, picture and globe have textures: bitmaps, and a checkerboard.", TEXTURED_ROOM),
        "stained_glass.xml": scene_text(
            "A lamp whose shade is a textured light: glass of many colours between strips of lead.", STAINED_GLASS),
    }
