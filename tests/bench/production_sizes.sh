#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Bakes one cumulus at the sizes of production, and measures Woodcock on it: reading, the first
# whole picture, memory, cost. With --cycles also Blender's Cycles. Prints a table in Markdown.
#
#   tests/bench/production_sizes.sh [--quick | --first] [--woodcock PROGRAM] [--cycles PYTHON]
#           [--python PYTHON] [--scratch DIRECTORY] [--threads N] [--clock wall|processor]
#           [RESOLUTION ...]
#
# --quick      a quarter of the samples
# --first      the first whole picture alone, without costs
# --woodcock   without it, the program that tools/demo.sh builds
# --cycles     a Python with the module bpy, as tests/bench/peers.sh installs in build/peers/cycles
# --python     one with OpenImageIO, as that script installs too (build/peers/mitsuba/bin/python)
# --scratch    where the volumes are baked (build/production)
# --threads    of each renderer (as many as there are cores)
# --clock      processor: seconds of the processor, for a machine that has other work
# RESOLUTION   voxels along the longest side: without any, 512, 1024 and 2048
set -euo pipefail
self=$(realpath "$0")
top=${self%/tests/bench/*}

usage() { sed -n '/^# Bakes/,/^# RESOLUTION/s/^# \{0,1\}//p' "$self"; }
options=() woodcock=$top/build/demo/tools/woodcock scratch=$top/build/production
python=$top/build/peers/mitsuba/bin/python threads=$(nproc)
resolutions=()
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --quick | --first) options+=("$1"); shift ;;
        --woodcock) woodcock=$(realpath -m "${2:?}"); shift 2 ;;
        --cycles) options+=(--cycles "$(realpath -ms "${2:?}")"); shift 2 ;;
        --python) python=$(realpath -ms "${2:?}"); shift 2 ;;
        --scratch) scratch=$(realpath -m "${2:?}"); shift 2 ;;
        --threads) threads=${2:?}; shift 2 ;;
        --clock) options+=(--clock "${2:?}"); shift 2 ;;
        -*) usage >&2; exit 2 ;;
        *) resolutions+=("$1"); shift ;;
    esac
done
((${#resolutions[@]})) || resolutions=(512 1024 2048)
fail() { echo "production_sizes.sh: $1" >&2; exit 2; }
[[ -x $woodcock ]] ||
    fail "there is no $woodcock; build it by tools/demo.sh, or name another by --woodcock"
[[ -x $python ]] ||
    fail "there is no $python; tests/bench/peers.sh installs it, or name another by --python"

mkdir -p "$scratch"
for resolution in "${resolutions[@]}"; do
    volume=$scratch/cumulus.$resolution.vdb
    [[ -e $volume ]] || "$woodcock" bake cumulus --resolution "$resolution" -o "$volume" -q
done
export PYTHONDONTWRITEBYTECODE=1
exec taskset -c "0-$((threads - 1))" "$python" "$top/tests/bench/peers/production_sizes.py" \
    --woodcock "$woodcock" --scene "$top/tests/bench/scenes/cumulus.toml" --scratch "$scratch" \
    --threads "$threads" "${options[@]}" "${resolutions[@]}"
