#!/usr/bin/env bash
# Installs what is missing and builds. Arguments go to `cmake --build`: --target opal, ...
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/setup.sh
echo "build: cmake --preset release && cmake --build --preset release $*"
cmake --preset release >/dev/null
cmake --build --preset release "$@"
