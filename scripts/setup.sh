#!/usr/bin/env bash
# Installs what Opal is built and run with on Debian 12 (apt-get, as root or by sudo). Does nothing where all is there.
#   scripts/setup.sh [PACKAGE ...]      more packages to install
set -euo pipefail

packages=(
    g++ cmake ninja-build python3                                # to build
    ocl-icd-opencl-dev opencl-headers opencl-clhpp-headers       # OpenCL's loader and headers
    pocl-opencl-icd                                              # an OpenCL device: the CPU
    libopenexr-dev libpng-dev libjpeg62-turbo-dev zlib1g-dev     # images
    libpugixml-dev                                               # XML
    libtinyobjloader-dev                                         # meshes
    libfmt-dev nlohmann-json3-dev libxxhash-dev                  # text, JSON, hashes
    catch2                                                       # tests
    "$@"
)

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
    echo "setup: everything is installed"
    exit 0
fi
if ! command -v apt-get >/dev/null; then
    echo "setup: no apt-get here; please install what these Debian packages hold: ${missing[*]}" >&2
    exit 1
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "setup: must be root, or have sudo, to install: ${missing[*]}" >&2; exit 1; }
    as_root=(sudo)
fi
echo "setup: installing ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
