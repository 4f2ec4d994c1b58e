"""The same rays through Opal and through Embree's rtcIntersect1 and rtcOccluded1, A B A B, hits compared."""
import json
import os
import subprocess
import tempfile

from peers.report import PeerError, spread

KINDS = ("camera", "bounce", "shadow")
HEADINGS = ["scene", "triangles", "rays", "Opal Mrays/s", "Embree Mrays/s", "Opal / Embree", "by CPU time", "hits that differ"]
RATES = ("mrays_per_second", "mrays_per_cpu_second")


def run(command):
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except OSError as e:
        raise PeerError(f"cannot run {command[0]}: {e}")
    if done.returncode:
        raise PeerError(f"`{' '.join(command)}` failed: {(done.stderr or done.stdout).strip()}")
    return done.stdout


def build(folder, name="embree_rays.cpp"):
    """A program beside this file, by default the replayer, compiled against the system's Embree 3."""
    source = os.path.join(os.path.dirname(__file__), name)
    binary = os.path.join(folder, os.path.splitext(name)[0])
    compiler = os.environ.get("CXX", "c++")
    try:
        run([compiler, "-std=c++20", "-O3", "-Wall", "-Wextra", source, "-o", binary, "-lembree3", "-pthread"])
    except PeerError as e:
        hint = "; Embree 3 is Debian's libembree-dev" if "embree3" in str(e) else ""
        raise PeerError(f"{e}{hint}")
    return binary


def compare_kind(options, scene, kind, replay, folder):
    files = {what: os.path.join(folder, what) for what in ("rays", "hits", "triangles", "json")}
    opal = [options.opal, "bench", "rays", scene, "--kind", kind, "--json", files["json"], *options.opal_args]
    dumps = [part for what in ("rays", "hits", "triangles") for part in (f"--dump-{what}", files[what])]
    ours, theirs = {rate: [] for rate in RATES}, {rate: [] for rate in RATES}
    for k in range(options.rounds):
        run(opal + (dumps if k == 0 else []))
        if not os.path.exists(files["json"]):
            raise PeerError(f"`{' '.join(opal)}` wrote no statistics")
        with open(files["json"]) as f:
            said = json.load(f)
        answer = json.loads(run([replay, files["triangles"], files["rays"], "any" if kind == "shadow" else "closest", "--compare", files["hits"]]))
        for rate in RATES:
            ours[rate].append(said[rate])
            theirs[rate].append(answer[rate])
    different = answer["different"]
    share = sum(different[what] for what in ("hit_or_miss", "distance")) / answer["rays"]
    name = os.path.splitext(os.path.basename(scene))[0]
    ratios = [spread([a / b for a, b in zip(ours[rate], theirs[rate])]) for rate in RATES]
    row = [f"{name}, {kind}", str(answer["triangles"]), str(answer["rays"]), spread(ours[RATES[0]]), spread(theirs[RATES[0]]), *ratios, f"{share:.1e} (and {different['triangle']} at an equal distance)"]
    return row, share <= options.differing


def compare(options, scene):
    """Table rows, one a kind of rays, and whether the hits agree."""
    with tempfile.TemporaryDirectory() as folder:
        replay = build(folder)
        results = [compare_kind(options, scene, kind, replay, folder) for kind in KINDS]
    return [row for row, _ in results], all(ok for _, ok in results)
