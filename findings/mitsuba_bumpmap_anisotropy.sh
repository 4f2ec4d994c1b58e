#!/bin/sh
# Mitsuba 3.9.1 (PyPI): within a `bumpmap`, also a flat one, an anisotropic material changes as its shape turns.
#
# Guess before the run: a `bumpmap` of a constant picture changes nothing, and directions that turn with a shape find
# the same f cos, however the shape is turned about its normal. Seen: so it is for a `roughconductor` of alpha 0.1 and
# 0.5 alone and within a flat `normalmap`. Within a flat `bumpmap` f cos grows from 0.146 to 1.55 as the rectangle
# turns by 90 degrees: the direction of its highlight stays where it was in the world. Isotropic materials are right.
# What helps: a `normalmap` in place of the `bumpmap`, or shapes whose dp/du is the x axis.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install -q mitsuba==3.9.1 numpy==2.4.6
cat > "$folder/turn.py" <<'PY'
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
T = mi.ScalarTransform4f


def picture(*texel):
    pixels = np.tile(np.array(texel, dtype=np.float32), (4, 4, 1))
    return {"type": "bitmap", "bitmap": mi.Bitmap(pixels), "raw": True}


def metal(alpha_v):
    return {"type": "roughconductor", "distribution": "ggx", "alpha_u": 0.1, "alpha_v": alpha_v}


def f_cos(bsdf, degrees):
    turn = T().rotate([0, 0, 1], degrees)
    scene = mi.load_dict({"type": "scene", "shape": {"type": "rectangle", "to_world": turn, "bsdf": bsdf}})
    si = scene.ray_intersect(mi.Ray3f([0.1, 0.2, 5], [0, 0, -1]))
    si.wi = si.to_local(turn @ mi.ScalarVector3f(0.5, 0, 0.8660254))
    wo = si.to_local(turn @ mi.ScalarVector3f(-0.2, 0, 0.9797959))
    return float(si.bsdf().eval(mi.BSDFContext(), si, wo)[0])


seen = []
for name, alpha_v in (("anisotropic", 0.5), ("isotropic", 0.1)):
    inner = metal(alpha_v)
    bsdfs = {"alone": inner,
             "in a flat normalmap": {"type": "normalmap", "normalmap": picture(0.5, 0.5, 1), "inner": inner},
             "in a flat bumpmap": {"type": "bumpmap", "height": picture(0.5), "inner": inner}}
    seen += [f"{name} {how}, turned by 0, 30, 60, 90 degrees: "
             + " ".join(f"{f_cos(bsdf, degrees):.3g}" for degrees in (0, 30, 60, 90)) for how, bsdf in bsdfs.items()]
print("\n".join(seen))
wanted = open(sys.argv[1] + "/wanted").read().splitlines()
sys.exit(0 if seen == wanted else "this has changed")
PY
cat > "$folder/wanted" <<'SEEN'
anisotropic alone, turned by 0, 30, 60, 90 degrees: 0.146 0.146 0.146 0.146
anisotropic in a flat normalmap, turned by 0, 30, 60, 90 degrees: 0.146 0.146 0.146 0.146
anisotropic in a flat bumpmap, turned by 0, 30, 60, 90 degrees: 0.146 0.213 0.629 1.55
isotropic alone, turned by 0, 30, 60, 90 degrees: 0.729 0.729 0.729 0.729
isotropic in a flat normalmap, turned by 0, 30, 60, 90 degrees: 0.729 0.729 0.729 0.729
isotropic in a flat bumpmap, turned by 0, 30, 60, 90 degrees: 0.729 0.729 0.729 0.729
SEEN
"$folder/venv/bin/python" "$folder/turn.py" "$folder"
