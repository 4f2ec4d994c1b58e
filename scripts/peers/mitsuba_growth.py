"""One render of one scene with Mitsuba 3, from its start to the files: what it takes, for scripts/bench_growth.

  mitsuba_growth.py VARIANT SCENE.xml SPP WIDTH HEIGHT [IMAGE.exr IMAGE.png]

Says one JSON line: CPU seconds (user + system of all threads) of loading, rendering and writing; `cpu`, of the whole process but
for the conversion of the scene from Nori's XML, which is ours; the wall seconds of writing; the version. The peak of memory is the
process's own. An error is {"error": ...}.
"""
import json
import sys
import time

import nori_to_mitsuba


def main():
    variant, path, spp, width, height, *files = sys.argv[1:]
    begun = time.process_time()
    import drjit as dr
    import mitsuba as mi
    mi.set_variant(variant)
    imported = time.process_time()
    scene, converted = nori_to_mitsuba.load_timed(mi, path, rr_depth=3, spp=int(spp), size=(int(width), int(height)))
    loaded = time.process_time()
    image = mi.render(scene, spp=int(spp), seed=0)
    dr.eval(image)
    dr.sync_thread()
    rendered, wall = time.process_time(), time.perf_counter()
    for file in files:
        mi.util.write_bitmap(file, image, write_async=False)
    written = time.process_time()
    print(json.dumps({"cpu": written - converted, "load": loaded - imported - converted, "render": rendered - loaded,
                      "write": written - rendered, "write_wall": time.perf_counter() - wall, "version": mi.__version__, "import": imported - begun}))


try:
    main()
except Exception as e:
    print(json.dumps({"error": f"{type(e).__name__}: {e}"}))
    sys.exit(1)
