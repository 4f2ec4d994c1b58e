#!/bin/sh
# Mitsuba 3.9.1 (PyPI): `path` renders a masked surface with nothing behind it too dark, by the factor of its opacity.
#
# Guess before the run: `path`, `direct` and `volpath` have the same mean, as they estimate the same light: that of a
# masked floor under a point light, with nothing else in the scene. Seen: at opacity 0.5 `path` has half the light of
# the two others, at 0.25 a quarter. The integrator gathers the point light at the mask, then draws whether the path
# passes on. If it does, and then leaves the scene, what was gathered is lost. A black wall behind the floor, or a
# constant sky of radiance 0, brings the light back.
# What helps: a `<emitter type="constant">` of radiance 0 in such a scene, or `volpath`.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q mitsuba==3.9.1 numpy==2.4.6
cat > "$folder/mask.py" <<'PY'
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
T = mi.ScalarTransform4f


def grey(value):
    return {"type": "rgb", "value": value}


WALL = {"type": "rectangle", "to_world": T().translate([0, 0, -1]).scale(100),
        "bsdf": {"type": "diffuse", "reflectance": grey(0.0)}}
SKY = {"type": "constant", "radiance": grey(0.0)}


def mean(integrator, opacity, **more):
    scene = {"type": "scene", "integrator": {"type": integrator},
             "sensor": {"type": "perspective", "fov": 20,
                        "to_world": T().look_at([0, 0, 4], [0, 0, 0], [0, 1, 0]),
                        "film": {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"}},
                        "sampler": {"type": "independent", "sample_count": 1024}},
             "floor": {"type": "rectangle", "to_world": T().scale(10),
                       "bsdf": {"type": "mask", "opacity": opacity,
                                "inner": {"type": "diffuse", "reflectance": grey(0.5)}}},
             "lamp": {"type": "point", "position": [0, 0, 2], "intensity": grey(4.0)}, **more}
    return float(np.array(mi.render(mi.load_dict(scene), seed=1)).mean())


seen = []
for opacity in (1.0, 0.5, 0.25):
    direct = mean("direct", opacity)  # 0.1418 times the opacity
    others = {"path": mean("path", opacity), "volpath": mean("volpath", opacity),
              "path before a black wall": mean("path", opacity, wall=WALL),
              "path before a black sky": mean("path", opacity, sky=SKY)}
    # Standard errors are below 0.01 of the means.
    seen += [f"opacity {opacity}, {name} over direct: {round(20 * value / direct) / 20}"
             for name, value in others.items()]
print("\n".join(seen))
wanted = open(sys.argv[1] + "/wanted").read().splitlines()
sys.exit(0 if seen == wanted else "this has changed")
PY
cat > "$folder/wanted" <<'SEEN'
opacity 1.0, path over direct: 1.0
opacity 1.0, volpath over direct: 1.0
opacity 1.0, path before a black wall over direct: 1.0
opacity 1.0, path before a black sky over direct: 1.0
opacity 0.5, path over direct: 0.5
opacity 0.5, volpath over direct: 1.0
opacity 0.5, path before a black wall over direct: 1.0
opacity 0.5, path before a black sky over direct: 1.0
opacity 0.25, path over direct: 0.25
opacity 0.25, volpath over direct: 1.0
opacity 0.25, path before a black wall over direct: 1.0
opacity 0.25, path before a black sky over direct: 1.0
SEEN
"$folder/venv/bin/python" "$folder/mask.py" "$folder"
