#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes sure that the Debian packages that Woodcock is built from are there.
set -euo pipefail

packages=(
    cmake ninja-build g++ ccache pkgconf
    libopenvdb-dev libopenvdb-ax-dev libboost-iostreams-dev libeigen3-dev zlib1g-dev
    libopenimageio-dev libopencolorio-dev libopenexr-dev libimath-dev
    libembree-dev libassimp-dev libnanovdb-dev libblosc-dev
    libhwy-dev libtbb-dev libfmt-dev libspdlog-dev
    libtomlplusplus-dev libmuparser-dev nlohmann-json3-dev libcli11-dev
    libgtest-dev libbenchmark-dev
    clang libclang-rt-14-dev
)

if ! command -v dpkg-query >/dev/null; then
    echo "Not a Debian system: please see to the equivalents of ${packages[*]}" >&2
    exit 0
fi

installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null || true)
missing=()
for package in "${packages[@]}"; do
    grep -qx "installed $package" <<<"$installed" || missing+=("$package")
done
((${#missing[@]})) || exit 0

if ((EUID == 0)); then
    as_root=(env)
elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [[ -t 0 ]]; }; then
    as_root=(sudo)
else
    echo "Missing packages, and neither root nor sudo to install them with. Please run, as root:" >&2
    echo "apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
fi

echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -q
"${as_root[@]}" DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${missing[@]}"
