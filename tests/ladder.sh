#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the scenes of data/scenes/ladder with Woodcock and with Blender's Cycles, twice each, and
# prints how the means of the pictures compare: Cycles / Woodcock, with its standard error.
#
#   tests/ladder.sh [--woodcock PROGRAM] [--blender PROGRAM] [--spp N] [SCENE ...]
#
# PROGRAM of --blender is as for woodcock cycles. Exit code 1: an unbiased mode differs by more
# than 4 standard errors, or by more than 0.3 % and 2 standard errors.
set -euo pipefail
cd "$(dirname "$0")/.."

woodcock=build/release/tools/woodcock
blender=()
spp=()
scenes=()
while (($#)); do
    case $1 in
        --woodcock) woodcock=$2; shift 2 ;;
        --blender) blender=(--blender "$2"); shift 2 ;;
        --spp) spp=(--spp "$2"); shift 2 ;;
        -*) echo "usage: $0 [--woodcock PROGRAM] [--blender PROGRAM] [--spp N] [SCENE ...]" >&2; exit 2 ;;
        *) scenes+=("$1"); shift ;;
    esac
done
ladder=data/scenes/ladder
out=build/ladder
if ((!${#scenes[@]})); then
    for file in "$ladder"/*.toml; do
        [[ $file == */sky_image.toml ]] || scenes+=("$(basename "$file" .toml)")
    done
fi

mkdir -p "$out"
bake() { # what, file, options
    [[ -e $out/$2.vdb ]] || "$woodcock" bake "$1" -o "$out/$2.vdb" -q "${@:3}" 2>/dev/null
}
bake "$ladder/recipes/constant.toml" constant --voxel 0.0625
bake "$ladder/recipes/ramp.toml" ramp --voxel 0.25
bake "$ladder/recipes/voxel.toml" voxel --voxel 0.5
bake "$ladder/recipes/colour.toml" colour --voxel 0.05
bake "$ladder/recipes/ball.toml" ball --voxel 0.05
bake cumulus cloud --resolution 96 --set size=2
[[ -e $out/sky.exr ]] || "$woodcock" render "$ladder/sky_image.toml" -o "$out/sky.exr" -q

printf '%-12s %-14s %8s  %-27s %-27s %s\n' scene Cycles seconds 'mean ratio (r, g, b)' \
    'standard error' verdict
failed=0
for scene in "${scenes[@]}"; do
    for seed in 1 2; do
        "$woodcock" render "$ladder/$scene.toml" -o "$out/$scene.woodcock.$seed.exr" --seed $seed \
            "${spp[@]}" -q
        "$woodcock" cycles "$ladder/$scene.toml" -o "$out/$scene.cycles.$seed.exr" --seed $seed \
            "${blender[@]}" "${spp[@]}" -q 2>/dev/null
    done
    "$woodcock" ladder-row
done
exit $failed
