#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows that the tests prove the program that users run: tools/demo.sh compiles each source by the
# same command as the tests' build. It compiles nothing.
#   tests/demo_flags.sh SCRATCH_FOLDER
set -euo pipefail
scratch=$(realpath -m "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

rm -rf "$scratch"
mkdir -p "$scratch"
for preset in release demo; do
    build=$scratch/$preset
    cmake --preset $preset -B "$build" -DCMAKE_UNITY_BUILD=OFF >"$build.log" 2>&1 ||
        { cat "$build.log"; exit 1; }
    sed -n "/\"command\": /{s|$build|BUILD|g;p}" "$build/compile_commands.json" |
        sort >"$build.commands"
done
other=$(comm -13 "$scratch/release.commands" "$scratch/demo.commands")
if [[ -n $other ]]; then
    echo "The demo compiles these otherwise than the preset release does:"
    echo "$other"
    exit 1
fi
echo "$(wc -l <"$scratch/demo.commands") sources are compiled by the same commands."
