"""What whole runs take as scenes grow, Opal beside Mitsuba 3 and Embree 3: CPU seconds, wall seconds and the peak of memory of each process
(wait4), medians of rounds in which all take turns. A first run of each is thrown away, so that caches of kernels and files are warm."""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

from peers import rays
from peers.report import PeerError

SCRIPTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
ROOT = os.path.dirname(SCRIPTS)
sys.path.insert(0, SCRIPTS)
from scenekit import displaced_sphere  # noqa: E402

SMALL = (64, 48)  # pixels, where the scene is what grows
EMPTY = 30        # triangles of a scene that weighs nothing
START_SCENES = ("cbox_mis", "veach_mis", "mixed_room")


def timed(command, env=None):
    """What the process said on stdout, and what it took."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        begun = time.perf_counter()
        process = subprocess.Popen(command, stdout=out, stderr=err, env={**os.environ, **(env or {})})
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        wall = time.perf_counter() - begun
        out.seek(0)
        err.seek(0)
        said = out.read().decode(errors="replace")
        if process.returncode:
            words = said.strip() if said.startswith('{"error"') else err.read().decode(errors="replace").strip()
            raise PeerError(f"`{' '.join(map(str, command))}` failed: {words}")
    return said, {"cpu": used.ru_utime + used.ru_stime, "wall": wall, "peak_mb": used.ru_maxrss / 1024}


class Opal:
    name = "Opal"

    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.version = timed([options.opal, "version"])[0].splitlines()

    def render(self, scene, spp, size, files=False, env=None):
        stats = os.path.join(self.folder, "opal.json")
        command = [self.options.opal, "render", scene, "--spp", str(spp), "--width", str(size[0]), "--height", str(size[1]), "--quiet", "--mis", "power",
                   "-o", os.path.join(self.folder, "opal.exr"), "--json", stats, *self.options.opal_args, *([] if files else ["--no-png"])]
        row = timed(command, env)[1]
        with open(stats) as f:
            seconds = json.load(f)["seconds"]
        return {**row, "write_wall": seconds["write"]}

    def sweep(self, strategies, env):
        out = os.path.join(self.folder, f"sweep_{len(strategies)}_{time.monotonic_ns()}")
        return timed([self.options.opal, "sweep", os.path.join(ROOT, "scenes/cbox_mis.xml"), "--width", "100", "--spp", "1,4", "--replicates", "2", "--quiet",
                      "-o", out, "--strategies", *strategies], env)[1]


class Mitsuba:
    name = "Mitsuba"

    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.env = {"DRJIT_LIBLLVM_PATH": options.llvm} if options.llvm else {}
        scene = sphere(folder, EMPTY)
        self.version = self.run(scene, 1, SMALL, False, {})["version"]

    def run(self, scene, spp, size, files, env):
        images = [os.path.join(self.folder, f"mitsuba.{kind}") for kind in ("exr", "png")] if files else []
        said, row = timed([self.options.python, os.path.join(SCRIPTS, "peers/mitsuba_growth.py"), "llvm_ad_rgb", scene, str(spp), *map(str, size), *images],
                          {**self.env, **env})
        return {**row, **json.loads(said)}

    def render(self, scene, spp, size, files=False, env=None):
        return {key: value for key, value in self.run(scene, spp, size, files, env or {}).items() if key != "version"}


class Embree:
    """Reading and the tree alone."""
    name = "Embree"

    def __init__(self, options, folder):
        self.binary = rays.build(folder, "embree_growth.cpp")
        self.version = self.run(sphere(folder, EMPTY))["version"]

    def run(self, scene):
        said, row = timed([self.binary, scene[:-len(".xml")].replace("/generated/", "/generated/meshes/") + ".obj"])
        return {**row, **json.loads(said)}

    def build(self, scene):
        return {key: value for key, value in self.run(scene).items() if key != "version"}


# Scenes, written to a folder `generated` where they are not.

def sphere(folder, triangles):
    place = os.path.join(folder, "generated")
    path = os.path.join(place, f"displaced_sphere_{triangles}.xml")
    if not os.path.exists(path):
        os.makedirs(os.path.join(place, "meshes"), exist_ok=True)
        name = f"displaced_sphere_{triangles}"
        with open(os.path.join(place, "meshes", f"{name}.obj"), "w") as file:
            count = displaced_sphere.write_obj(file, triangles)
        with open(path, "w") as file:
            file.write(displaced_sphere.scene(name, count).text())
    return path


CUBE = "\n".join([f"v {x} {y} {z}" for x in (0, 1) for y in (0, 1) for z in (0, 1)] +
                 ["f 1 2 4 3", "f 5 7 8 6", "f 1 5 6 2", "f 3 4 8 7", "f 1 3 7 5", "f 2 6 8 4"]) + "\n"
FRAME = """<scene>
<integrator type="path_tracer_recursive"><boolean name="nee" value="true"/><boolean name="mis" value="true"/></integrator>
<camera type="perspective"><float name="fov" value="40"/><transform name="toWorld"><lookat origin="0,1.2,2.2" target="0,0,0" up="0,1,0"/></transform></camera>
<mesh type="parallelogram"><point name="origin" value="-1 0 1"/><vector name="u" value="2 0 0"/><vector name="v" value="0 0 -2"/></mesh>
"""


def grid(count):
    side = max(1, round(count**0.5))
    return [(2 * (i % side) / side - 1, 2 * (i // side) / side - 1, 1 / side) for i in range(count)]


def cubes(folder, count):
    """A floor of so many cubes, each a mesh with a BSDF of its own, under one lamp."""
    path = os.path.join(folder, f"cubes_{count}.xml")
    with open(os.path.join(folder, "cube.obj"), "w") as file:
        file.write(CUBE)
    with open(path, "w") as file:
        file.write(FRAME)
        for k, (x, z, size) in enumerate(grid(count)):
            file.write(f'<mesh type="obj"><string name="filename" value="cube.obj"/><transform name="toWorld"><scale value="{size:g},{size:g},{size:g}"/>'
                       f'<translate value="{x:g},0,{z:g}"/></transform><bsdf type="diffuse"><color name="albedo" value="0.5 {0.2 + 0.6 * k / count:g} 0.3"/></bsdf></mesh>\n')
        file.write(lamp(-0.5, -0.5, 1, 10) + "</scene>\n")
    return path


def lamp(x, z, size, radiance):
    return (f'<mesh type="parallelogram"><point name="origin" value="{x:g} 1.5 {z:g}"/><vector name="u" value="{size:g} 0 0"/><vector name="v" value="0 0 {size:g}"/>'
            f'<emitter type="area"><color name="radiance" value="{radiance:g} {radiance:g} {radiance:g}"/></emitter></mesh>\n')


def lamps(folder, count):
    """A floor under so many square lamps, whose powers span four decades."""
    path = os.path.join(folder, f"lamps_{count}.xml")
    with open(path, "w") as file:
        file.write(FRAME)
        for k, (x, z, size) in enumerate(grid(count)):
            file.write(lamp(x, z, size / 2, 10**(4 * ((k * 0.6180339887) % 1) - 2)))
        file.write("</scene>\n")
    return path


def strategies(count):
    """Different strategies for a scene with one lamp, as `opal sweep --strategies` takes them."""
    every = [f"lighting={light},hemisphere={hemisphere},rr={rr},sampler={sampler}" for light in ("bsdf", "emitter", "mis,mis=balance", "mis,mis=power")
             for hemisphere in ("uniform", "cosine") for rr in ("fixed", "throughput", "throughput-eta") for sampler in ("independent", "stratified", "sobol")]
    return [every[k * len(every) // count] for k in range(count)]


# Measurements. A row: {"n": size, renderer: {"cpu", "wall", "peak_mb" and what else it said: medians}}.

def in_turns(runs, rounds):
    """runs: {renderer: function}, each called once unmeasured and then once a round."""
    for run in runs.values():
        run()
    rows = {name: [] for name in runs}
    for _ in range(rounds):
        for name, run in runs.items():
            rows[name].append(run())
    return {name: {key: statistics.median(row[key] for row in all_rows) for key in all_rows[0]} for name, all_rows in rows.items()}


class Growth:
    """renderers: those of Opal, Mitsuba and Embree that are there, by name."""

    def __init__(self, options, folder, say):
        self.options, self.folder, self.say = options, folder, say
        self.renderers, self.missing = {}, {}
        for kind in (Opal, Mitsuba, Embree):
            try:
                self.renderers[kind.name] = kind(options, folder)
            except PeerError as error:
                if kind is Opal:
                    raise
                self.missing[kind.name] = str(error)
                say(f"without {kind.name}: {error}")

    def row(self, part, n, runs, rounds=None):
        row = {"n": n, **in_turns(runs, rounds or self.options.rounds)}
        self.say(f"{part:<9} {n:>9}: " + ", ".join(f"{name} {r['cpu']:.3g} CPU s, {r['peak_mb']:.0f} MB" for name, r in row.items() if name != "n"))
        return row

    def whole(self, part, n, scene, spp, size, files=False):
        return self.row(part, n, {name: lambda r=r: r.render(scene, spp, size, files) for name, r in self.renderers.items() if hasattr(r, "render")})

    def empty(self):
        """The start of each program: what a scene that weighs nothing takes."""
        scene = sphere(self.folder, EMPTY)
        runs = {name: lambda r=r: r.render(scene, 1, SMALL) if hasattr(r, "render") else r.build(scene) for name, r in self.renderers.items()}
        return [self.row("empty", EMPTY, runs)]

    def triangles(self):
        rows = []
        for n in self.options.triangles:
            scene = sphere(self.folder, n)
            runs = {name: lambda r=r: r.render(scene, 1, SMALL) if hasattr(r, "render") else r.build(scene) for name, r in self.renderers.items()}
            rows.append(self.row("triangles", n, runs))
        return rows

    def meshes(self):
        return [self.whole("meshes", n, cubes(self.folder, n), 16, (320, 240)) for n in self.options.meshes]

    def lights(self):
        return [self.whole("lights", n, lamps(self.folder, n), 16, (320, 240)) for n in self.options.lights]

    def images(self):
        scene = os.path.join(ROOT, "scenes/cbox_mis.xml")
        return [self.whole("images", w * h, scene, 2, (w, h), True) for w, h in self.options.images]

    def starts(self):
        """64 x 64 pixels, one sample, with an empty cache: the first scene, further ones, and the first one again."""
        rows = {}
        for name, renderer in self.renderers.items():
            if not hasattr(renderer, "render"):
                continue
            for _ in range(self.options.rounds):
                with tempfile.TemporaryDirectory() as cache:
                    env = {"POCL_CACHE_DIR": cache, "HOME": cache}  # Dr.Jit keeps its kernels in ~/.drjit
                    for k, scene in enumerate((*START_SCENES, START_SCENES[0])):
                        what = f"{k + 1}: {scene}"
                        run = renderer.render(os.path.join(ROOT, f"scenes/{scene}.xml"), 1, (64, 64), False, env)
                        rows.setdefault(what, {}).setdefault(name, []).append(run)
        medians = [{"n": what, **{name: {key: statistics.median(r[key] for r in runs) for key in runs[0]} for name, runs in of.items()}} for what, of in rows.items()]
        for row in medians:
            self.say(f"start     {row['n']}: " + ", ".join(f"{name} {row[name]['cpu']:.3g} CPU s" for name in row if name != "n"))
        return medians

    def sweeps(self):
        rows = []
        for n in self.options.strategies:
            def run():
                with tempfile.TemporaryDirectory() as cache:
                    return self.renderers["Opal"].sweep(strategies(n), {"POCL_CACHE_DIR": cache})
            row = {"n": n, "Opal": run()}
            self.say(f"sweep     {n:>9}: Opal {row['Opal']['cpu']:.3g} CPU s, {row['Opal']['peak_mb']:.0f} MB")
            rows.append(row)
        return rows
