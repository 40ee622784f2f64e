#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs the tests that use threads under ThreadSanitizer. Arguments go to ctest: -R Session
#
# ThreadSanitizer must see how oneTBB hands work from thread to thread. Otherwise every hand-over
# looks like a race. So this script builds oneTBB with ThreadSanitizer too, from the distribution's
# source package, into the preset's build directory. It changes nothing of the system.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(nproc)}
build=$PWD/build/thread-sanitizer
onetbb=$build/onetbb  # the preset's TBB_ROOT

# The source package from the user's own mirrors: apt gets a copy of its list of sources, in which
# `deb` is `deb-src`.
fetch_onetbb() {
    local apt=$build/apt list parts file
    rm -rf "$apt"
    mkdir -p "$apt"/{lists/partial,cache/archives/partial,parts}
    eval "$(apt-config shell list Dir::Etc::SourceList/f parts Dir::Etc::SourceParts/d)"
    for file in "$list" "$parts"/*.list; do
        [[ -e $file ]] && sed -n 's/^deb[[:space:]]/deb-src /p' "$file" >>"$apt/parts/all.list"
    done
    for file in "$parts"/*.sources; do
        [[ -e $file ]] && sed 's/^Types:.*/Types: deb-src/' "$file" >"$apt/parts/${file##*/}"
    done
    local options=(-q -o APT::Sandbox::User=root -o Dir::Cache="$apt/cache" -o Dir::State::Lists="$apt/lists"
        -o Dir::Etc::SourceList=/dev/null -o Dir::Etc::SourceParts="$apt/parts")
    apt-get "${options[@]}" update
    (cd "$apt" && apt-get "${options[@]}" source --download-only --tar-only onetbb)
    mkdir "$apt/onetbb"
    tar -xf "$apt"/onetbb_*.orig.tar.* --strip-components=1 -C "$apt/onetbb"
}

# TBB's own allocator is left out: ThreadSanitizer would not see what memory is freed and used
# again.
build_onetbb() {
    cmake -S "$build/apt/onetbb" -B "$build/apt/build" -DCMAKE_BUILD_TYPE=RelWithDebInfo \
        -DCMAKE_INSTALL_PREFIX="$onetbb" -DCMAKE_INSTALL_LIBDIR=lib \
        -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF
    cmake --build "$build/apt/build"
    cmake --install "$build/apt/build"
    if ! grep -q __tsan_init "$onetbb/lib/libtbb.so"; then
        rm -r "$onetbb"
        echo "oneTBB has been built without ThreadSanitizer" >&2
        exit 1
    fi
}

# The tests that run every parallel loop of the library. `grep -rl tbb:: lib` names the field, the
# majorants, block ranges and the reading of voxels (grid/), the session (render/), the loading of
# albedo (scene/) and all of bake/. Tests of render/ that only render longer are left out, as
# everything takes ten times as long.
tests='^(Field|Majorants|BlockRanges|VdbLoad|LoadScene|Session|Bak|Ax)'

cmake/packages.sh
if [[ ! -e $onetbb/lib/libtbb.so ]]; then
    fetch_onetbb
    build_onetbb
fi
cmake --preset thread-sanitizer
cmake --build --preset thread-sanitizer
(($#)) || set -- -R "$tests"
exec ctest --preset thread-sanitizer "$@"
