#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds everything and runs all tests. Arguments go to ctest: tests/run.sh -R Field
# WOODCOCK_UNITY=ON compiles several sources at a time: less work from scratch, and more after a
# change.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

cmake/packages.sh
cmake --preset release -DCMAKE_UNITY_BUILD="${WOODCOCK_UNITY:-OFF}"
cmake --build --preset release
exec ctest --preset release --parallel "$CMAKE_BUILD_PARALLEL_LEVEL" "$@"
