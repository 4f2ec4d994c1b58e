#!/usr/bin/env python3
"""Writes the scenes of scenes/, their meshes and their images. Plain Python 3, no dependencies, the same bytes every time.

  scripts/make_scenes.py                         write scenes/*.xml, scenes/meshes and scenes/textures
  scripts/make_scenes.py --check                 compare them with what is there; exit 1 where they differ
  scripts/make_scenes.py --displaced-sphere N    write scenes/generated/displaced_sphere_N.xml and its mesh of about N triangles
"""
import argparse
import pathlib
import sys

from scenekit import (cornell_box, displaced_sphere, eta_study, fence, images, lights, materials, mitsuba, textured,
                      write)

SCENES = pathlib.Path(__file__).resolve().parent.parent / "scenes"


def all_files():
    """{path: text or bytes} of everything that is kept in the repository."""
    files = {}
    for module in (cornell_box, lights, materials, eta_study):
        for name, (surface, comment) in module.meshes().items():
            files[SCENES / "meshes" / f"{name}.obj"] = write.obj_text(surface, comment)
        for scene in module.scenes():
            files[SCENES / f"{scene.name}.xml"] = scene.text()
    for module in (mitsuba, fence, textured):
        for name, data in module.files().items():
            files[SCENES / name] = data
    return files


def write_displaced_sphere(triangles):
    folder = SCENES / "generated"
    (folder / "meshes").mkdir(parents=True, exist_ok=True)
    name = f"displaced_sphere_{triangles}"
    with open(folder / "meshes" / f"{name}.obj", "w") as file:
        count = displaced_sphere.write_obj(file, triangles)
    (folder / f"{name}.xml").write_text(displaced_sphere.scene(name, count).text())
    print(f"{folder / name}.xml: {count} triangles")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="write nothing, compare")
    parser.add_argument("--displaced-sphere", type=int, metavar="N", help="triangles, from 30 to tens of millions")
    options = parser.parse_args()
    if options.displaced_sphere:
        return write_displaced_sphere(options.displaced_sphere)
    files = all_files()
    if options.check:
        differing = [str(path) for path, data in files.items() if not path.exists() or not images.same(path, data)]
        if differing:
            sys.exit("differs from what scripts/make_scenes.py writes: " + ", ".join(differing))
        return None
    for path, data in files.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data.encode() if isinstance(data, str) else data)
    print(f"{len(files)} files, {sum(map(len, files.values())) / 1e3:.0f} kB in {SCENES}")


if __name__ == "__main__":
    main()
