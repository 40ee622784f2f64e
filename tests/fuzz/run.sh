#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the fuzz targets and runs each over a bounded number of inputs, the same ones each time.
# usage: run.sh BUILD_DIRECTORY FUZZ_SEEDS [CLANG++]
set -euo pipefail
build=$1 seeds=$2 clang=${3:-}
if [[ ! -x $clang ]]; then
    echo "skipped: no clang++, which brings libFuzzer"
    exit 77
fi

cmake --preset fuzz -S "$(dirname "${BASH_SOURCE[0]}")/../.." -B "$build" -DCMAKE_CXX_COMPILER="$clang"
cmake --build "$build" --parallel "${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}"

# The number of inputs for each. The time limit is long, as the code is not optimised. Leaks are not
# looked for: a tree that is damaged halfway leaks in OpenVDB.
declare -A runs=([scene]=20000 [display]=2000 [vdb]=1000)
rm -rf "$build/corpus"
"$seeds" "$build/corpus"
fuzz() {
    ASAN_OPTIONS=detect_leaks=0 "$build/tests/fuzz/$1_fuzz" -runs="${runs[$1]}" -seed=1 \
        -timeout=30 -rss_limit_mb=2048 -max_len=32768 -print_final_stats=1 -verbosity=0 \
        -artifact_prefix="$build/" "$build/corpus/$1" >"$build/$1.log" 2>&1
}
# All at a time, as each runs on one thread.
declare -A processes
for name in scene display vdb; do
    fuzz $name &
    processes[$name]=$!
done
failed=()
for name in scene display vdb; do
    wait "${processes[$name]}" || failed+=("$name")
    echo "== $name: ${runs[$name]} inputs"
    cat "$build/$name.log"
done
if ((${#failed[@]})); then
    echo "These fail: ${failed[*]}"
    exit 1
fi
