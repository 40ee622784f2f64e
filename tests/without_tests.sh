#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Proves that the sources build without tests/: no other source includes a file of it, and a copy of
# the tree without it configures, with all that it would compile and install at hand.
# usage: without_tests.sh SCRATCH_FOLDER
set -euo pipefail
scratch=$1
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
# Ninja refuses targets of which a source is missing, without compiling anything.
ninja -C "$scratch/build" -n all >"$scratch/steps.log" || { cat "$scratch/steps.log"; exit 1; }
if grep -n 'source/tests/' "$scratch/steps.log" "$scratch/build/build.ninja"; then
    echo "These steps need files of tests/."
    exit 1
fi
echo "$(grep -c 'Building CXX object' "$scratch/steps.log") sources compile without tests/."
