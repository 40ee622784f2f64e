#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves the build that users run. tools/demo.sh compiles for this machine's processor, the tests for any: the native program must pass
# `verify` too, and it must give the same bits, of volumes and of pictures.
# usage: native_build.sh WOODCOCK PIXEL_DIGEST   (the plain program, and tests/programs/pixel_digest)
set -euo pipefail
plain=$(realpath "$1") digest=$(realpath "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
native=$PWD/build/demo/tools/woodcock

cmake --preset demo
cmake --build --preset demo --target woodcock_program --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
"$native" verify --quick

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch"/{plain,native}

# draw SCENE [ARGUMENT...]: by both programs.
draw() {
    local scene=$1 name build
    name=$(basename "$scene" .toml)
    shift
    for build in plain native; do
        "${!build}" render "$scene" -o "$scratch/$build/$name.exr" --res 64x48 --spp 4 --quiet "$@"
    done
}

for build in plain native; do
    "${!build}" bake cumulus --resolution 64 -o "$scratch/$build/cloud.vdb" --quiet
    "${!build}" bake explosion --resolution 64 -o "$scratch/$build/explosion.vdb" --quiet
done
cloud=(--set "volume[0].file=$scratch/plain/cloud.vdb")
for scene in demo chromatic; do draw data/scenes/$scene.toml "${cloud[@]}"; done
draw data/scenes/overlap.toml "${cloud[@]}" --set "volume[1].file=$scratch/plain/cloud.vdb"
draw data/scenes/fire.toml --set "volume[0].file=$scratch/plain/explosion.vdb"
for scene in box_of_fog gems glass tea window; do draw data/scenes/$scene.toml; done

for build in plain native; do
    (cd "$scratch/$build" && "$digest" ./*.exr && sha256sum ./*.vdb) >"$scratch/$build.digests"
done
if ! diff "$scratch/plain.digests" "$scratch/native.digests"; then
    echo "The native build (>) gives other bits than the plain one (<)."
    exit 1
fi
echo "$(wc -l <"$scratch/plain.digests") volumes and pictures have the same bits in both builds."
