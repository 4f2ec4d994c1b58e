"""An evening sky as an environment map: an OpenEXR file of half floats, in plain Python."""
import math
import struct

from scenekit.images import mix, noise
from scenekit.vec import dot, norm

WIDTH, HEIGHT = 256, 128
SUN = norm((-0.78, 0.4, -0.3))
SUN_RADIANCE, SUN_PIXELS = (420, 300, 180), 24  # behind haze: 7 degrees across


def exr(width, height, rows):
    """An OpenEXR file of half floats, uncompressed, the same bytes everywhere. rows: from the top, of (red, green, blue)."""
    def attribute(name, kind, data):
        return f"{name}\0{kind}\0".encode() + struct.pack("<i", len(data)) + data

    half, linear_and_reserved, sampling = 1, 0, (1, 1)
    channels = b"".join(name + b"\0" + struct.pack("<4i", half, linear_and_reserved, *sampling) for name in (b"B", b"G", b"R"))
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<2i", 20000630, 2) + b"".join([
        attribute("channels", "chlist", channels + b"\0"), attribute("compression", "compression", b"\0"),
        attribute("dataWindow", "box2i", window), attribute("displayWindow", "box2i", window),
        attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        attribute("screenWindowWidth", "float", struct.pack("<f", 1))]) + b"\0"
    size = 6 * width
    first = len(header) + 8 * height
    data = header + b"".join(struct.pack("<Q", first + y * (8 + size)) for y in range(height))
    for y, row in enumerate(rows):
        values = [pixel[channel] for channel in (2, 1, 0) for pixel in row]
        data += struct.pack("<2i", y, size) + struct.pack(f"<{len(values)}e", *values)
    return data


def direction(x, y):
    """Of the middle of pixel x, y, as Opal and Mitsuba look it up: y is up, the first row is the pole."""
    theta, phi = math.pi * y / (HEIGHT - 1), 2 * math.pi * (x + 0.5) / WIDTH
    return math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi)


def clouds(d):
    """How much of the sky clouds hide, on a plane above."""
    if d[1] < 0.02:
        return 0
    u, v = 1.1 * d[0] / (d[1] + 0.12), -1.1 * d[2] / (d[1] + 0.12)
    height = sum(noise(u * 2**k + 40, v * 2**k + 40, 1 << 20, 1 << 20, k) / 2**k for k in range(4)) / 1.875
    cover = min(1, max(0, (height - 0.47) / 0.22))
    return cover * cover * (3 - 2 * cover) * min(1, d[1] / 0.12)


def radiance(d):
    toward = max(0, dot(d, SUN))
    warm = toward**6
    if d[1] < 0:  # the ground, in haze near the horizon
        return mix((0.52, 0.44, 0.36), (0.16, 0.13, 0.1), min(1, -d[1] * 6))
    low = (1 - d[1]) ** 4
    sky = mix((0.1, 0.22, 0.52), mix((0.62, 0.6, 0.62), (1.7, 0.95, 0.45), warm), low)
    sky = tuple(c + glow * (0.5 * toward**24 + 3 * toward**200) for c, glow in zip(sky, (2.2, 1.35, 0.7)))
    return mix(sky, mix((0.62, 0.6, 0.66), (2.6, 1.7, 1.05), toward**3), 0.85 * clouds(d))


def environment_map():
    rows = [[radiance(direction(x, y)) for x in range(WIDTH)] for y in range(HEIGHT)]
    by_angle = sorted(((x, y) for y in range(HEIGHT) for x in range(WIDTH)), key=lambda p: -dot(direction(*p), SUN))
    for x, y in by_angle[:SUN_PIXELS]:
        rows[y][x] = SUN_RADIANCE
    return exr(WIDTH, HEIGHT, rows)
