"""Nori's XML scenes, as Opal reads them, in Mitsuba 3's dictionary form.

The subset that both renderers mean the same by: OBJ meshes with toWorld, parallelograms, area emitters, diffuse,
mirror and dielectric BSDFs, the perspective camera, four reconstruction filters, the independent sampler. Anything
else is an error that names what there is: a peer that renders another picture measures nothing.

What is said explicitly because the defaults differ: fov is the full horizontal angle; a mesh or an emitter without a
BSDF is diffuse 0.5; diffuse and mirror are one-sided in both; an OBJ without vn keeps its facets (Mitsuba would smooth
them); both cameras look along +z with +x left in the image, so a mirroring `<scale value="-1,1,1"/>` carries over.

`to_dict` needs numpy alone until its result is loaded; matrices stay numpy arrays and `load` makes transforms of them.
"""
import math
import os
import time
import xml.etree.ElementTree as ET

import numpy as np

OBJECTS = ("scene", "mesh", "bsdf", "emitter", "camera", "integrator", "sampler", "rfilter")
PATH_TRACERS = ("path_tracer_recursive", "path_mats", "path_ems", "path_mis")
GAUSSIAN_BY_DEFAULT = ("path_mats", "path_ems", "path_mis")  # upstream's integrator names; the course's filter by a box


class SceneError(Exception):
    """The scene holds what this converter, or Mitsuba, has no equal for."""


def pick(table, key, what):
    if key not in table:
        raise SceneError(f"no {what} '{key}' in the Mitsuba form; available: {', '.join(sorted(table))}")
    return table[key]


def numbers(text, count):
    values = [float(t) for t in text.replace(",", " ").split()]
    if len(values) != count:
        raise SceneError(f"'{text}': expected {count} numbers")
    return values


def properties(node):
    """Name -> value of a node's own properties; transforms as 4x4 arrays."""
    read = {"integer": int, "float": float, "string": str, "boolean": lambda t: t.lower() == "true",
            "point": lambda t: np.array(numbers(t, 3)), "vector": lambda t: np.array(numbers(t, 3)),
            "color": lambda t: numbers(t, 3)}
    found = {}
    for child in node:
        if child.tag == "transform":
            found[child.get("name")] = transform(child)
        elif child.tag not in OBJECTS:
            found[child.get("name")] = pick(read, child.tag, "property")(child.get("value"))
    return found


def child_of(node, tag):
    found = [c for c in node if c.tag == tag]
    if len(found) > 1:
        raise SceneError(f"<{node.tag}> has {len(found)} children <{tag}>; at most one is meaningful")
    return found[0] if found else None


# Transforms: operations act on a point in document order, so each multiplies from the left.

def rotation(axis, degrees):
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = math.radians(degrees)
    return np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)  # Rodrigues


def look_at(origin, target, up):
    unit = lambda v: v / np.linalg.norm(v)
    d = unit(target - origin)
    left = unit(np.cross(unit(up), d))
    return np.column_stack([left, unit(np.cross(d, left)), d])


def operation(node):
    m = np.eye(4)
    triple = lambda name: np.array(numbers(node.get(name), 3))
    if node.tag == "translate":
        m[:3, 3] = triple("value")
    elif node.tag == "scale":
        m[:3, :3] = np.diag(triple("value"))
    elif node.tag == "rotate":
        m[:3, :3] = rotation(triple("axis"), float(node.get("angle")))
    elif node.tag == "matrix":
        m = np.array(numbers(node.get("value"), 16)).reshape(4, 4)
    elif node.tag == "lookat":
        m[:3, :3] = look_at(triple("origin"), triple("target"), triple("up"))
        m[:3, 3] = triple("origin")
    else:
        raise SceneError(f"unknown transform <{node.tag}>")
    return m


def transform(node):
    m = np.eye(4)
    for child in node:
        m = operation(child) @ m
    return m


# Objects.

def rgb(values):
    return {"type": "rgb", "value": values}


def microfacet(p):
    """kd / pi + ks D F G / (4 cos cos), ks = 1 - max(kd): a blend by ks of a diffuse base and a rough conductor without absorption,
    whose Fresnel reflectance is a dielectric's; drawn by D cos as Nori does."""
    kd = p.get("kd", [0.5] * 3)
    most = max(kd)
    base = {"type": "diffuse", "reflectance": rgb([c / most if most > 0 else 0 for c in kd])}
    coat = {"type": "roughconductor", "distribution": "beckmann", "alpha": p.get("alpha", 0.1), "sample_visible": False,
            "eta": p.get("intIOR", 1.5046) / p.get("extIOR", 1.000277), "k": 0.0}
    return {"type": "blendbsdf", "weight": 1 - most, "base": base, "coat": coat}


def bsdf(node):
    makers = {
        "microfacet": microfacet,
        "diffuse": lambda p: {"type": "diffuse", "reflectance": rgb(p.get("albedo", [0.5] * 3))},
        "mirror": lambda p: {"type": "conductor", "material": "none"},
        "dielectric": lambda p: {"type": "dielectric", "int_ior": p.get("intIOR", 1.5046),
                                 "ext_ior": p.get("extIOR", 1.000277)},
    }
    if node is None:
        return makers["diffuse"]({})
    return pick(makers, node.get("type"), "bsdf")(properties(node))


def emitter(node):
    area = lambda p: {"type": "area", "radiance": rgb(p["radiance"])}
    return pick({"area": area, "parallelogram_emitter": area}, node.get("type"), "emitter")(properties(node))


def find_file(folder, name):
    name = name.replace("\\", "/")
    for candidate in (os.path.join(folder, name), name):
        if os.path.isfile(candidate):
            return candidate
    raise SceneError(f"no file '{name}' in {folder}")


def obj(node, folder):
    p = properties(node)
    path = find_file(folder, p["filename"])
    with open(path) as lines:
        smooth = any(line.startswith("vn ") for line in lines)
    return {"type": "obj", "filename": path, "face_normals": not smooth, "to_world": p.get("toWorld", np.eye(4))}


def parallelogram(node, folder):
    """Mitsuba's rectangle is [-1, 1]^2 with normal +z; the columns send it to o + (x+1)/2 u + (y+1)/2 v, normal u x v."""
    p = properties(node)
    u, v = p["u"], p["v"]
    m = np.eye(4)
    m[:3, :3] = np.column_stack([u / 2, v / 2, np.cross(u, v)])
    m[:3, 3] = p["origin"] + u / 2 + v / 2
    return {"type": "rectangle", "to_world": p.get("toWorld", np.eye(4)) @ m}


def shape(node, folder):
    d = pick({"obj": obj, "parallelogram": parallelogram}, node.get("type"), "mesh")(node, folder)
    d["bsdf"] = bsdf(child_of(node, "bsdf"))
    light = child_of(node, "emitter")
    if light is not None:
        d["emitter"] = emitter(light)
    return d


def rfilter(node, default):
    known = {"box": {}, "tent": {}, "gaussian": {"stddev": 0.5}, "mitchell": {}}  # radii 0.5, 1, 2, 2 in both
    kind = default if node is None else node.get("type")
    if node is not None and properties(node):
        raise SceneError(f"the parameters of rfilter '{kind}' are not converted")
    return {"type": kind, **pick(known, kind, "rfilter")}


def camera(node, spp, size, default_filter):
    p = properties(node)
    pick({"perspective": 0}, node.get("type"), "camera")
    width, height = size or (p.get("width", 1280), p.get("height", 720))
    return {"type": "perspective", "fov": p.get("fov", 30.0), "fov_axis": "x",
            "near_clip": p.get("nearClip", 1e-4), "far_clip": p.get("farClip", 1e4), "to_world": p.get("toWorld", np.eye(4)),
            "film": {"type": "hdrfilm", "width": width, "height": height, "pixel_format": "rgb",
                     "component_format": "float32", "rfilter": rfilter(child_of(node, "rfilter"), default_filter)},
            "sampler": {"type": "independent", "sample_count": spp}}


def to_dict(path, rr_depth, spp=None, size=None):
    """Mitsuba's dictionary of the scene at `path`, to be rendered by its path integrator (BSDF and emitter sampling, MIS).

    rr_depth: the depth from which Russian roulette may end a path, counted as Mitsuba does. spp, size (width, height):
    in place of the scene's own. Depth is unbounded, emitters are seen by the camera.
    """
    root = ET.parse(path).getroot()
    if root.tag != "scene":
        raise SceneError(f"{path}: the root is <{root.tag}>, expected <scene>")
    folder = os.path.dirname(os.path.abspath(path))
    kind = child_of(root, "integrator").get("type")
    if kind not in PATH_TRACERS:
        raise SceneError(f"{path}: integrator '{kind}' has no equal in Mitsuba; available: {', '.join(PATH_TRACERS)}")
    sampler = child_of(root, "sampler")
    own_spp = properties(sampler).get("sampleCount", 1) if sampler is not None else 1
    scene = {"type": "scene",
             "integrator": {"type": "path", "max_depth": -1, "rr_depth": rr_depth, "hide_emitters": False},
             "sensor": camera(child_of(root, "camera"), spp or own_spp, size,
                              "gaussian" if kind in GAUSSIAN_BY_DEFAULT else "box")}
    for i, mesh in enumerate(root.findall("mesh")):
        scene[f"shape_{i}"] = shape(mesh, folder)
    return scene


def load_timed(mi, path, **options):
    """The loaded scene, in the variant that is set in the module `mi`, and the CPU seconds that its conversion took."""
    def with_transforms(d):
        return {k: mi.ScalarTransform4f(v) if isinstance(v, np.ndarray) else with_transforms(v) if isinstance(v, dict) else v
                for k, v in d.items()}
    begun = time.process_time()
    converted = with_transforms(to_dict(path, **options))
    seconds = time.process_time() - begun
    return mi.load_dict(converted), seconds


def load(mi, path, **options):
    return load_timed(mi, path, **options)[0]
