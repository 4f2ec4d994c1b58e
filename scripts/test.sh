#!/usr/bin/env bash
# Installs, builds, and runs the tests (but those labelled `long`). Arguments go to ctest: -L host, -R image, ...
# OPAL_PRESET: as in build.sh.
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${OPAL_PRESET:-release}

scripts/build.sh
echo "test: ctest --preset $preset $*"
ctest --preset "$preset" "$@"
