#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Shows that nothing outside tests/ needs it: no other source includes a file of it, and a copy of the
# tree without it configures, with every file at hand that its build needs. It compiles nothing.
#   tests/without_tests.sh SCRATCH_FOLDER
set -euo pipefail
scratch=$(realpath -m "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if grep -rnE '#include "tests/' lib tools; then
    echo "These lines include files of tests/."
    exit 1
fi
rm -rf "$scratch"
mkdir -p "$scratch/source"
cp -r CMakeLists.txt LICENSE cmake data lib tools "$scratch/source"
cmake -S "$scratch/source" -B "$scratch/build" -G Ninja >"$scratch/configure.log" 2>&1 ||
    { cat "$scratch/configure.log"; exit 1; }
ninja -C "$scratch/build" -t inputs all >"$scratch/inputs.log"
grep -qF "$scratch/source/tools/main.cpp" "$scratch/inputs.log"
grep -F "$scratch/source/" "$scratch/inputs.log" | while read -r file; do
    [[ -e $file && $file != "$scratch/source/tests/"* ]] || { echo "The build needs $file."; exit 1; }
done
echo "$(grep -cE "^$scratch/source/.*\.cpp$" "$scratch/inputs.log") sources need no file of tests/."
