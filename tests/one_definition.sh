#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves the one-definition rule for the whole program: two types of one name that differ would link
# without a word, and one of them would be used for both. The compiler sees them where it links all
# sources together (-flto), and reports them as errors here.
#   tests/one_definition.sh BUILD_FOLDER
set -euo pipefail
build=$(realpath -m "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=None -DWOODCOCK_BUILD_TESTS=OFF \
    -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 \
    -DCMAKE_CXX_FLAGS="-O0 -flto" -DCMAKE_EXE_LINKER_FLAGS="-flto=auto -Werror=odr"
cmake --build "$build" --target woodcock_verify_program \
    --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
