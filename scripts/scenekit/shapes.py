"""Shapes as Surface values: closed ones are wound outwards (counter-clockwise seen from outside), y is up.

A face is a tuple of corners: indices (position, normal), or (position, normal, uv) where a surface has texture coordinates.
normal None means the geometric normal.
"""
import math
from dataclasses import dataclass, field

from scenekit.vec import add, cross, dot, norm, scale, sub


@dataclass
class Surface:
    positions: list
    normals: list = field(default_factory=list)
    faces: list = field(default_factory=list)
    uvs: list = field(default_factory=list)

    def triangle_count(self):
        return sum(len(face) - 2 for face in self.faces)

    def area(self):
        """Area of the faces as fans of triangles, the way the renderer cuts them."""
        total = 0.0
        for face in self.faces:
            p = [self.positions[corner[0]] for corner in face]
            for k in range(1, len(p) - 1):
                n = cross(sub(p[k], p[0]), sub(p[k + 1], p[0]))
                total += math.sqrt(dot(n, n)) / 2
        return total


def polygons(corner_lists):
    """Flat polygons that share equal corners: no normals, so the geometric ones count."""
    surface, index = Surface([]), {}
    for corners in corner_lists:
        for p in corners:
            if p not in index:
                index[p] = len(surface.positions)
                surface.positions.append(p)
        surface.faces.append(tuple((index[p], None) for p in corners))
    return surface


def box(lo=(0, 0, 0), hi=(1, 1, 1)):
    (a, b, c), (d, e, f) = lo, hi
    return polygons([[(a, b, c), (d, b, c), (d, b, f), (a, b, f)], [(a, e, c), (a, e, f), (d, e, f), (d, e, c)],
                     [(a, b, c), (a, b, f), (a, e, f), (a, e, c)], [(d, b, c), (d, e, c), (d, e, f), (d, b, f)],
                     [(a, b, c), (a, e, c), (d, e, c), (d, b, c)], [(a, b, f), (d, b, f), (d, e, f), (a, e, f)]])


def icosphere(level, smooth=True):
    """Unit sphere of 20 * 4^level triangles with corners on the sphere."""
    g = (1 + math.sqrt(5)) / 2
    points = [norm(p) for p in [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g),
                                (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                 (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11),
                 (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(level):
        middles, finer = {}, []

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(points)
                points.append(norm(add(points[i], points[j])))
            return middles[key]

        for i, j, k in triangles:
            a, b, c = middle(i, j), middle(j, k), middle(k, i)
            finer += [(i, a, c), (a, j, b), (c, b, k), (a, b, c)]
        triangles = finer
    if not smooth:
        return Surface(points, [], [tuple((i, None) for i in t) for t in triangles])
    return Surface(points, list(points), [tuple((i, i) for i in t) for t in triangles])


def grid(rows, columns, point, normal, wrap_rows=False, wrap_columns=False):
    """Quads over point(i, j) with smooth normal(i, j), 0 <= i <= rows and 0 <= j <= columns; a wrapped side joins up.

    The front is the side of (d/di) x (d/dj).
    """
    height, width = rows + (not wrap_rows), columns + (not wrap_columns)
    cells = [(i, j) for i in range(height) for j in range(width)]
    surface = Surface([point(i, j) for i, j in cells], [norm(normal(i, j)) for i, j in cells])
    at = lambda i, j: ((i % height) * width + j % width,) * 2
    surface.faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for i in range(rows) for j in range(columns)]
    return surface


def torus(major, minor, rows, columns):
    """Torus about the y axis."""
    def ring(i):
        return (math.cos(2 * math.pi * i / rows), 0, -math.sin(2 * math.pi * i / rows))

    def normal(i, j):
        t = 2 * math.pi * j / columns
        return add(scale(ring(i), math.cos(t)), (0, math.sin(t), 0))

    return grid(rows, columns, lambda i, j: add(scale(ring(i), major), scale(normal(i, j), minor)), normal, True, True)


def torus_knot(p, q, major, minor, tube, rows, columns):
    """Tube along the (p, q) torus knot: p turns about the y axis, q about the core circle."""
    def curve(t):
        r = major + minor * math.cos(q * t)
        return (r * math.cos(p * t), minor * math.sin(q * t), -r * math.sin(p * t))

    def frame(i):
        t, h = 2 * math.pi * i / rows, 1e-4
        tangent = norm(sub(curve(t + h), curve(t - h)))
        core = scale((math.cos(p * t), 0, -math.sin(p * t)), major)
        side = norm(cross(tangent, sub(curve(t), core)))  # across the tube, along the torus that carries the knot
        return side, cross(side, tangent)

    def normal(i, j):
        t = 2 * math.pi * j / columns
        side, up = frame(i)
        return add(scale(side, math.cos(t)), scale(up, math.sin(t)))

    return grid(rows, columns, lambda i, j: add(curve(2 * math.pi * i / rows), scale(normal(i, j), tube)), normal, True, True)


def lathe(profile, rows, columns):
    """Turns the smooth profile(s) = (radius, height), s from 0 to 1, about the y axis; the front is on the profile's right."""
    def normal(i, j):
        s, h = i / rows, 1e-4
        (r0, y0), (r1, y1) = profile(max(0, s - h)), profile(min(1, s + h))
        a = 2 * math.pi * j / columns
        return ((y1 - y0) * math.cos(a), -(r1 - r0), -(y1 - y0) * math.sin(a))

    def point(i, j):
        a = 2 * math.pi * j / columns
        r, y = profile(i / rows)
        return (r * math.cos(a), y, -r * math.sin(a))

    # a row runs up the profile and a column around: (d/di) x (d/dj) would point inwards, so rows are turned about
    surface = grid(rows, columns, lambda i, j: point(rows - i, j), lambda i, j: normal(rows - i, j), False, True)
    surface.faces = [_without_repeats(surface.positions, face) for face in surface.faces]  # quads that touch the axis
    return surface


def _without_repeats(positions, face):
    return tuple(c for k, c in enumerate(face) if positions[c[0]] != positions[face[k - 1][0]])


def join(parts):
    """One surface of several: sharp where they meet, since each keeps its own normals."""
    surface = Surface([])
    for part in parts:
        p, n = len(surface.positions), len(surface.normals)
        surface.positions += part.positions
        surface.normals += part.normals
        surface.faces += [tuple((i + p, j + n) for i, j in face) for face in part.faces]
    return surface


def segment(a, b):
    """The straight profile from a to b."""
    return lambda s: (a[0] + (b[0] - a[0]) * s, a[1] + (b[1] - a[1]) * s)


def band(inner, outer, height, columns):
    """Solid ring of rectangular section about the y axis, standing on y = 0: smooth around, sharp at its edges."""
    corners = [(inner, 0), (outer, 0), (outer, height), (inner, height), (inner, 0)]
    return join(lathe(segment(a, b), 1, columns) for a, b in zip(corners, corners[1:]))


def height_field(width, depth, rows, columns, height):
    """y = height(x, z) over [-width/2, width/2] x [-depth/2, depth/2], front up."""
    place = lambda i, j: (width * (j / columns - 0.5), depth * (i / rows - 0.5))
    h = 1e-4 * min(width, depth)

    def normal(i, j):
        x, z = place(i, j)
        return ((height(x - h, z) - height(x + h, z)) / (2 * h), 1, (height(x, z - h) - height(x, z + h)) / (2 * h))

    def point(i, j):
        x, z = place(i, j)
        return (x, height(x, z), z)

    return grid(rows, columns, point, normal)
