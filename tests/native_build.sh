#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves the build that users run. tools/demo.sh compiles for this machine's processor, the tests
# for any processor. The native program must pass `verify` too, and must give the same bits of
# volumes and of pictures as the plain program.
#   tests/native_build.sh WOODCOCK PIXEL_DIGEST
# WOODCOCK is the plain program, PIXEL_DIGEST is tests/programs/pixel_digest.
set -euo pipefail
plain=$(realpath "$1") digest=$(realpath "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
native=$PWD/build/demo/tools/woodcock

# What is not compiled for this processor is compiled as in the plain build: ccache has it already.
unity=ON
if command -v ccache >/dev/null; then unity=${WOODCOCK_UNITY:-OFF}; fi
cmake --preset demo -DCMAKE_UNITY_BUILD=$unity
cmake --build --preset demo --target woodcock_program woodcock_verify_program \
    --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"
"$native" verify --quick
exec tests/same_bits.sh "$plain" "$native" "$digest"
