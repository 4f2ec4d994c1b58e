#!/usr/bin/env bash
# Installs, builds, and runs the tests (but those labelled `long`). Arguments go to ctest: -L host, -R image, ...
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/build.sh
echo "test: ctest --preset release $*"
ctest --preset release "$@"
