"""Whole renders: Opal against Mitsuba 3, A B A B, the same scene at the same strategy (path tracing with BSDF and emitter
sampling, power heuristic, roulette by throughput). Rates are camera paths a second of render time, warm: Opal's kernel time, Mitsuba's
mi.render until the pixels are there."""
import glob
import json
import math
import os
import resource
import statistics
import subprocess
import tempfile
from xml.etree import ElementTree

from peers.report import PeerError, spread

SPECIALISE = ["--specialise", "on"]  # one kernel for pilots and renders
STRATEGY = ["--lighting", "mis", "--mis", "power", "--rr", "throughput-eta"]  # of Nori's scenes; Mitsuba's say theirs
SIGMA = 4  # combined standard errors by which two mean luminances may differ
HINTS = {"No module named": "; install it with `python3 -m venv V; V/bin/pip install mitsuba numpy` and name it with --python V/bin/python",
         "LLVM shared library": "; it is Debian's libllvm19, name it with --llvm, or leave it out with --variants scalar_rgb"}


def is_mitsuba(scene):
    """Is the file one of Mitsuba's? Their root has a version."""
    return ElementTree.parse(scene).getroot().get("version") is not None


def installed_llvm():
    """The newest libLLVM from 17 on that Debian's packages left here; None lets Dr.Jit search by itself."""
    found = [(v, path) for v in range(17, 30) for path in glob.glob(f"/usr/lib/*/libLLVM-{v}.so") + glob.glob(f"/usr/lib/*/libLLVM.so.{v}*")]
    return max(found)[1] if found else None


class Mitsuba:
    """One variant with one scene loaded, in a process of its own."""

    def __init__(self, options, variant, scene):
        self.name = variant
        env = dict(os.environ)
        if options.llvm:
            env["DRJIT_LIBLLVM_PATH"] = options.llvm
        worker = os.path.join(os.path.dirname(__file__), "mitsuba_worker.py")
        size = [str(options.width), str(options.height)] if options.width else []
        self.log = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen([options.python, worker, variant, scene, "none" if is_mitsuba(scene) else str(options.rr_depth), *size], env=env, text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log)
        hello = self.answer()
        self.pixels, self.version, self.box_filter = hello["width"] * hello["height"], hello["version"], hello["box_filter"]

    def answer(self):
        line = self.process.stdout.readline()
        said = json.loads(line) if line.startswith("{") else {"error": self.last_words()}
        if "error" in said:
            self.process.kill()
            hints = [hint for sign, hint in HINTS.items() if sign in said["error"]]
            raise PeerError(f"Mitsuba ({self.name}): {said['error']}{''.join(hints)}")
        return said

    def last_words(self):
        self.log.seek(0)
        return (self.log.read().strip().splitlines() or ["it ended without a word"])[-1]

    def render(self, spp, seed):
        self.process.stdin.write(f"{spp} {seed}\n")
        self.process.stdin.flush()
        r = self.answer()
        paths = self.pixels * spp
        return {"rate": paths / r["wall"], "cpu_rate": paths / r["cpu"], "paths": paths, "mean": r["mean_luminance"],
                "stderr": r["pixel_stderr"], "comparable": self.box_filter, "invalid": 0}

    def close(self):
        self.process.stdin.close()
        self.process.wait()


class Opal:
    name = "opal"

    def __init__(self, options, scene):
        self.options, self.scene = options, scene
        self.strategy = SPECIALISE if is_mitsuba(scene) else [*SPECIALISE, *STRATEGY, "--rr-depth", str(options.rr_depth)]
        self.start_cpu = 0.0
        self.start_cpu = min(self.run(1, seed)[1] for seed in (1, 2))  # loading, and the driver's compiler until its cache is warm

    def run(self, spp, seed):
        """Statistics and CPU seconds of one process."""
        with tempfile.TemporaryDirectory() as folder:
            stats = os.path.join(folder, "stats.json")
            command = [self.options.opal, "render", self.scene, "-o", os.path.join(folder, "image.exr"), "--no-png", "--quiet", "--json", stats,
                       "--spp", str(spp), "--seed", str(seed), *self.strategy, *self.options.opal_args]
            if self.options.width:
                command += ["--width", str(self.options.width), "--height", str(self.options.height)]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            try:
                done = subprocess.run(command, capture_output=True, text=True)
            except OSError as e:
                raise PeerError(f"cannot run Opal: {e}; build it (`cmake --build --preset release`) or name it with --opal")
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            if done.returncode or not os.path.exists(stats):
                raise PeerError(f"`{' '.join(command)}` failed: {(done.stderr or done.stdout).strip()}")
            with open(stats) as f:
                return json.load(f), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def render(self, spp, seed):
        r, cpu = self.run(spp, seed)
        self.pixels = r["width"] * r["height"]
        paths = self.pixels * spp
        # Below a clear excess over the start the figure would be noise.
        excess = cpu - self.start_cpu
        return {"rate": r["samples_per_second"], "cpu_rate": paths / excess if excess > 0.2 * self.start_cpu else None,
                "paths": paths, "mean": r["mean_luminance"], "stderr": r["stderr_luminance"],
                "invalid": r["invalid_samples"]}


def fitting_spp(renderer, seconds):
    """Samples a pixel that take about `seconds`, found by two pilots; the renderer is warm afterwards."""
    renderer.render(1, 900)
    pilot = renderer.render(4, 901)
    spp = max(4, round(seconds / 10 * pilot["rate"] / renderer.pixels))
    return max(4, round(seconds * renderer.render(spp, 902)["rate"] / renderer.pixels))


def relative(ours, theirs):
    """Our runs over theirs, pair by pair in the order they ran; `equal_error` compares 1 / (variance x CPU seconds), where
    the filter is a box: Opal's variance is that of the samples, Mitsuba's that of its filtered pixels."""
    def ratio(key):
        return [a[key] / b[key] for a, b in zip(ours, theirs) if a[key] and b[key]]

    def cost(run, stderr):
        return stderr**2 * run["paths"] / run["cpu_rate"]

    mean = lambda runs: statistics.fmean(r["mean"] for r in runs)
    error = lambda runs: runs[-1]["stderr"] / math.sqrt(len(runs))
    variance_of = theirs[-1]["stderr"]  # the last run knows the variance of all of them
    difference = mean(ours) - mean(theirs)
    return {"rate": ratio("rate"), "cpu_rate": ratio("cpu_rate"),
            "equal_error": [cost(b, variance_of) / cost(a, a["stderr"]) for a, b in zip(ours, theirs) if b["comparable"] and a["cpu_rate"]],
            "difference": difference / mean(theirs), "z": difference / math.hypot(error(ours), error(theirs))}


def compare(options, scene):
    """Table rows, one a variant, and whether all means agree. Prints each renderer's own figures on the way."""
    renderers = [Opal(options, scene)] + [Mitsuba(options, v, scene) for v in options.variants]
    spp = [fitting_spp(r, options.seconds) for r in renderers]
    runs = [[] for _ in renderers]
    for k in range(options.rounds):
        for renderer, samples, done in zip(renderers, spp, runs):
            done.append(renderer.render(samples, k + 1))
    name = os.path.splitext(os.path.basename(scene))[0]
    for renderer, samples, done in zip(renderers, spp, runs):
        rate = spread([r["rate"] / 1e6 for r in done])
        cpu = spread([r["cpu_rate"] / 1e6 for r in done if r["cpu_rate"]])
        print(f"  {name}, {renderer.name}: {samples} spp, {rate} M paths/s, {cpu} M paths per CPU-second, "
              f"{sum(r['invalid'] for r in done)} invalid", flush=True)
    rows, agree = [], True
    for peer, done in zip(renderers[1:], runs[1:]):
        r = relative(runs[0], done)
        agree = agree and abs(r["z"]) < SIGMA
        rows.append([name, f"Mitsuba {peer.version} {peer.name}", spread(r["rate"]), spread(r["cpu_rate"]), spread(r["equal_error"]),
                     f"{100 * r['difference']:+.2f} % (z {r['z']:+.1f})"])
        peer.close()
    return rows, agree


HEADINGS = ["scene", "against", "paths/s", "paths per CPU-second", "time to equal error", "mean luminance"]
