#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the program for this machine and renders the demo scene. Arguments go to the renderer:
# tools/demo.sh --spp 256
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
build=build/demo

cmake/packages.sh
cmake --preset demo
cmake --build --preset demo --target woodcock_program
# The program holds the recipe.
[[ $build/cloud.vdb -nt $build/tools/woodcock ]] ||
    $build/tools/woodcock bake congestus --resolution 500 -o $build/cloud.vdb
$build/tools/woodcock render data/scenes/demo.toml -o $build/demo.exr -o $build/demo.png "$@"
echo "The picture: $PWD/$build/demo.png, and for compositing: $PWD/$build/demo.exr"
