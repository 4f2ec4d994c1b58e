"""Images of textures: PNG files in plain Python, and the noise that paints them."""
import math
import struct
import zlib


def png(width, height, color):
    """A PNG of 8 bits. color(x, y): (red, green, blue) in [0, 1] of the pixel's middle, rows from the top, as sRGB has them.
    Up to 256 colours become a palette."""
    pixels = [tuple(round(255 * min(1, max(0, c))) for c in color(x, y)) for y in range(height) for x in range(width)]
    palette = {c: i for i, c in enumerate(sorted(set(pixels)))}
    indexed = len(palette) <= 256
    rows = bytearray()
    for y in range(height):
        row = pixels[y * width:(y + 1) * width]
        line = bytes(palette[c] for c in row) if indexed else bytes(channel for c in row for channel in c)
        if indexed:
            rows += b"\0" + line
        else:  # each value less that of the pixel before: smooth pictures become smaller
            rows += b"\1" + bytes((value - (line[k - 3] if k >= 3 else 0)) & 255 for k, value in enumerate(line))
    header = struct.pack(">IIBBBBB", width, height, 8, 3 if indexed else 2, 0, 0, 0)
    chunks = [(b"IHDR", header)]
    if indexed:
        chunks.append((b"PLTE", bytes(channel for c in palette for channel in c)))
    chunks += [(b"IDAT", zlib.compress(bytes(rows), 9)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)


def content(data):
    """The chunks of a PNG, those of pixels decompressed: zlib's versions pack the same pixels into different bytes."""
    chunks, at = [], 8
    while at < len(data):
        size, = struct.unpack_from(">I", data, at)
        chunks.append((data[at + 4:at + 8], data[at + 8:at + 8 + size]))
        at += size + 12
    pixels = b"".join(part for kind, part in chunks if kind == b"IDAT")
    return [chunk for chunk in chunks if chunk[0] != b"IDAT"], zlib.decompress(pixels)


def same(file, data):
    """Does the file hold that text, or those bytes?"""
    there = file.read_bytes()
    if isinstance(data, str):
        return there == data.encode()
    is_png = there[:8] == data[:8] == b"\x89PNG\r\n\x1a\n"
    return content(there) == content(data) if is_png else there == data


def mix(a, b, share):
    return tuple(p + (q - p) * share for p, q in zip(a, b))


def random_number(*key):
    """A number in [0, 1) for each tuple of integers."""
    return zlib.crc32(struct.pack(f"<{len(key)}i", *key)) / 2**32


def noise(x, y, period_x, period_y, seed=0):
    """Smooth value noise in [0, 1], of one knot a unit; it repeats after the periods, which are integers."""
    i, j = math.floor(x), math.floor(y)
    fade = lambda t: t * t * (3 - 2 * t)
    knot = lambda a, b: random_number((i + a) % period_x, (j + b) % period_y, seed)
    u, v = fade(x - i), fade(y - j)
    low, high = knot(0, 0) + (knot(1, 0) - knot(0, 0)) * u, knot(0, 1) + (knot(1, 1) - knot(0, 1)) * u
    return low + (high - low) * v
