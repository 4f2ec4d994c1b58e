#!/bin/sh
# Mitsuba 3.9.1 (PyPI): a textured `area` light sheds other light by light samples than by BSDF samples, by its shape.
#
# Guess before the run: a lamp whose radiance is a texture of one colour sheds on a floor what the lamp of that colour
# without a texture does, whether the floor samples the light (`direct` with `emitter_samples` 1, `bsdf_samples` 0) or
# its BSDF (0 and 1). Seen: BSDF samples do. Light samples agree for a rectangle and a mesh, have 0.8 of it for a
# sphere and nothing for a cube. A rectangle that `flip_normals` turns away from the floor still lights it by light
# samples, as if it were not turned. With `path` and `direct` by default the sum is in between, by their MIS weights.
# What helps: no texture on the radiance of spheres, cubes and shapes with `flip_normals`; rectangles that a rotation
# turns.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q mitsuba==3.9.1 numpy==2.4.6
cat > "$folder/lamps.py" <<'PY'
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
T = mi.ScalarTransform4f
DOWN = T().translate([0.5, 0, 2]).scale(0.6).rotate([1, 0, 0], 180)
LAMPS = {"rectangle": {}, "sphere": {}, "cube": {}, "rectangle, flip_normals": {"flip_normals": True}}


def grey(value):
    return {"type": "rgb", "value": value}


def mesh():
    """A pyramid with texture coordinates, its base down."""
    corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0], [0, 0, 1]]
    made = mi.Mesh("pyramid", 5, 6, has_vertex_texcoords=True)
    parameters = mi.traverse(made)
    points = np.array(corners, dtype=np.float32) * 0.6 + np.array([0.5, 0, 2], dtype=np.float32)
    parameters["vertex_positions"] = points.ravel()
    parameters["vertex_texcoords"] = ((np.array(corners)[:, :2] + 1) / 2).astype(np.float32).ravel()
    parameters["faces"] = np.array([0, 2, 1, 0, 3, 2, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4], dtype=np.uint32)
    parameters.update()
    made.write_ply(sys.argv[1] + "/pyramid.ply")
    return {"type": "ply", "filename": sys.argv[1] + "/pyramid.ply", "face_normals": True}


def mean(lamp, radiance, emitter_samples, bsdf_samples):
    scene = {"type": "scene",
             "integrator": {"type": "direct", "emitter_samples": emitter_samples, "bsdf_samples": bsdf_samples},
             "sensor": {"type": "perspective", "fov": 8, "to_world": T().look_at([4, 0, 1], [0, 0, 0], [0, 0, 1]),
                        "film": {"type": "hdrfilm", "width": 4, "height": 4, "rfilter": {"type": "box"}},
                        "sampler": {"type": "independent", "sample_count": 32768}},
             "floor": {"type": "rectangle", "to_world": T().scale(10),
                       "bsdf": {"type": "diffuse", "reflectance": grey(1.0)}},
             "lamp": {**lamp, "emitter": {"type": "area", "radiance": radiance}}}
    return float(np.array(mi.render(mi.load_dict(scene), seed=1)).mean())


def textured():
    return {"type": "checkerboard", "color0": grey(0.9), "color1": grey(0.9)}


seen = []
lamps = {name: {"type": name.split(",")[0], "to_world": DOWN, **more} for name, more in LAMPS.items()}
lamps["mesh"] = mesh()
for name, lamp in lamps.items():
    turned = {key: value for key, value in lamp.items() if key != "flip_normals"}
    plain = mean(turned, grey(0.9), 1, 0)
    by_light, by_bsdf = mean(lamp, textured(), 1, 0) / plain, mean(lamp, textured(), 0, 1) / plain
    seen.append(f"{name}: light samples {round(by_light, 1)}, BSDF samples {round(by_bsdf, 1)}")
print("\n".join(seen))
wanted = open(sys.argv[1] + "/wanted").read().splitlines()
sys.exit(0 if seen == wanted else "this has changed")
PY
# Of the light of the same lamp without texture and flip_normals; standard errors are below 0.01.
cat > "$folder/wanted" <<'SEEN'
rectangle: light samples 1.0, BSDF samples 1.0
sphere: light samples 0.8, BSDF samples 1.0
cube: light samples 0.0, BSDF samples 1.0
rectangle, flip_normals: light samples 1.0, BSDF samples 0.0
mesh: light samples 1.0, BSDF samples 1.0
SEEN
"$folder/venv/bin/python" "$folder/lamps.py" "$folder"
