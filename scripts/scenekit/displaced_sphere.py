"""A sphere with bumps of every size, of as many triangles as one asks for: written row by row, never held in memory."""
import math

from scenekit.lights import BLACK
from scenekit.write import LICENCE, Scene, diffuse, path_tracer

WAVES = [(0.08, 3, 0.3), (0.05, 7, 1.1), (0.03, 17, 2.3), (0.015, 41, 0.7), (0.008, 97, 1.9)]  # height, frequency, phase


def rings_for(triangles):
    """Rings of 2 * rings cells: 2 * columns * (rings - 1) triangles in all, the nearest count to the one asked for."""
    return max(3, round((1 + math.sqrt(1 + triangles)) / 2))


def write_obj(file, triangles):
    rings = rings_for(triangles)
    columns = 2 * rings
    angles = [2 * math.pi * j / columns for j in range(columns)]
    circle = [(math.cos(a), -math.sin(a)) for a in angles]
    around = [[math.sin(f * a + phase) for a in angles] for _, f, phase in WAVES]
    count = 2 * columns * (rings - 1)
    file.write(f"# Displaced sphere, {count} triangles\n# {LICENCE}\nv 0 1 0\n")
    for i in range(1, rings):
        t = math.pi * i / rings
        y, r = math.cos(t), math.sin(t)
        w = [h * r * math.sin(f * t + phase) for h, f, phase in WAVES]  # r: no displacement at the poles, where rows meet
        w0, w1, w2, w3, w4 = w
        rows = []
        for (x, z), a, b, c, d, e in zip(circle, *around):
            s = 1 + w0 * a + w1 * b + w2 * c + w3 * d + w4 * e
            rows.append("v %.7g %.7g %.7g\n" % (s * r * x, s * y, s * r * z))
        file.write("".join(rows))
    file.write("v 0 -1 0\n")
    last = 2 + columns * (rings - 1)
    file.write("".join(f"f 1 {2 + j} {2 + (j + 1) % columns}\n" for j in range(columns)))
    for i in range(rings - 2):
        a, b = 2 + i * columns, 2 + (i + 1) * columns
        file.write("".join(f"f {a + j} {b + j} {b + (j + 1) % columns} {a + (j + 1) % columns}\n" for j in range(columns)))
    a = last - columns
    file.write("".join(f"f {a + j} {last} {a + (j + 1) % columns}\n" for j in range(columns)))
    return count


def scene(name, triangles):
    result = Scene(name, f"A displaced sphere of {triangles} triangles on a floor under two lights: for benchmarks of ray tracing.",
                   path_tracer(), 16)
    result.camera((0, 1.2, 4.4), (0, -0.05, 0), 40, 640, 480)
    result.parallelogram((-8, -1.2, 8), (16, 0, 0), (0, 0, -16), diffuse(0.5, 0.5, 0.5))
    result.parallelogram((-8, -1.2, -3), (16, 0, 0), (0, 10, 0), diffuse(0.3, 0.35, 0.4))
    result.mesh(name, diffuse(0.7, 0.6, 0.45))
    result.parallelogram((-2.5, 3, 1), (1.5, 0, 0), (0.3, 0.3, 1.5), BLACK, (30, 28, 26))
    result.parallelogram((1.8, 2.2, 1.6), (1, 0, -0.4), (0.2, -0.4, 0.8), BLACK, (20, 22, 26))
    return result
