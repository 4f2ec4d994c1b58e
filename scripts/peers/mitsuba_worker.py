"""Renders one scene with Mitsuba 3 as often as it is asked, so that its JIT stays warm between the runs of a benchmark.

  mitsuba_worker.py VARIANT SCENE.xml RR_DEPTH [WIDTH HEIGHT]

RR_DEPTH is none for a file of Mitsuba's own, which is rendered as it is; one of Nori's is translated.
Says one JSON line when the scene is loaded, {width, height, version, box_filter}, then answers each line `SPP SEED` on its input with
one: wall and cpu (user + system of all threads) seconds of that render, until its pixels are there; mean_luminance of that
image and pixel_stderr, the standard error of that mean by the variance of each pixel between the renders of equal SPP so far
(null at the first; by a wider filter pixels share samples, and vary less). An error is {"error": ...} and the end.
"""
import json
import os
import sys
import time

import nori_to_mitsuba


class PixelVariance:
    """Variance between images of equal spp, summed over the pixels (Welford)."""

    def __init__(self):
        self.count, self.mean, self.squares = 0, 0, 0

    def add(self, image):
        self.count += 1
        off = image - self.mean
        self.mean = self.mean + off / self.count
        self.squares = self.squares + off * (image - self.mean)

    def stderr(self):
        """Of the mean over one image's pixels."""
        return None if self.count < 2 else float(self.squares.sum() / (self.count - 1)) ** 0.5 / self.mean.size


def timed_render(mi, dr, scene, spp, seed):
    wall, cpu = time.perf_counter(), time.process_time()
    image = mi.render(scene, spp=spp, seed=seed)
    if dr.is_jit_v(mi.Float):
        dr.eval(image)
        dr.sync_thread()
    return image, time.perf_counter() - wall, time.process_time() - cpu


def load_own(mi, path, size):
    """A file of Mitsuba's, with another size of the film."""
    scene = mi.load_file(path)
    if size:
        params = mi.traverse(scene.sensors()[0])
        params["film.size"] = size
        params["film.crop_size"] = size
        params.update()
    return scene


def main():
    variant, path, rr_depth = sys.argv[1:4]
    size = tuple(int(a) for a in sys.argv[4:6]) or None
    import drjit as dr
    import mitsuba as mi
    import numpy as np
    mi.set_variant(variant)
    scene = load_own(mi, path, size) if rr_depth == "none" else nori_to_mitsuba.load(mi, path, rr_depth=int(rr_depth), size=size)
    film = scene.sensors()[0].film()
    width, height = film.size()
    say = lambda **answer: print(json.dumps(answer), flush=True)
    say(width=int(width), height=int(height), version=mi.__version__, box_filter="BoxFilter" in str(film.rfilter()))
    luminance = np.array([0.212671, 0.715160, 0.072169])
    of_spp = {}
    for line in sys.stdin:
        spp, seed = (int(t) for t in line.split())
        image, wall, cpu = timed_render(mi, dr, scene, spp, seed)
        grey = np.array(image, dtype=np.float64)[..., :3] @ luminance  # further channels are those of moment and aov
        variance = of_spp.setdefault(spp, PixelVariance())
        variance.add(grey)
        say(wall=wall, cpu=cpu, mean_luminance=float(grey.mean()), pixel_stderr=variance.stderr())


try:
    main()
except Exception as e:
    print(json.dumps({"error": f"{type(e).__name__}: {e}"}), flush=True)
    sys.exit(1)
