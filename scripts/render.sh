#!/usr/bin/env bash
# From a bare Debian 12 machine to a picture: installs, builds, renders a scene to an EXR and a PNG in the current
# folder.
#   scripts/render.sh [SCENE.xml [options of `opal render`]]
set -euo pipefail
top=$(cd "$(dirname "$0")/.." && pwd)

OPAL_PRESET=release "$top/scripts/build.sh" --target opal
[ $# -gt 0 ] || set -- "$top/scenes/cbox_mis.xml"
echo "render: build/release/opal render $*"
"$top/build/release/opal" render "$@"
