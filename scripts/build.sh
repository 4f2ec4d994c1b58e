#!/usr/bin/env bash
# Installs what is missing and builds. Arguments go to `cmake --build`: --target opal, ...
# OPAL_PRESET: release, or dev, where warnings are errors.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${OPAL_PRESET:-release}

scripts/setup.sh
echo "build: cmake --preset $preset && cmake --build --preset $preset $*"
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset" "$@"
