#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds everything and runs all tests. Arguments go to ctest: tests/run.sh -R Field
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}

cmake/packages.sh
cmake --preset release
cmake --build --preset release
exec ctest --preset release --parallel "$CMAKE_BUILD_PARALLEL_LEVEL" "$@"
