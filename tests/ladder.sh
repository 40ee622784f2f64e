#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Renders the scenes of data/scenes/ladder with Woodcock and with Blender's Cycles, twice each, and
# prints how the means of the pictures compare: Cycles / Woodcock, with its standard error.
#
#   tests/ladder.sh [--build DIRECTORY] [--blender PROGRAM] [--spp N] [SCENE ...]
#
# PROGRAM is as for woodcock cycles. Exit code 1: some pictures differ, by more than 4 standard
# errors or 0.3 %.
set -euo pipefail
cd "$(dirname "$0")/.."

build=build/release
cycles=()
spp=()
scenes=()
while (($#)); do
    case $1 in
        --build) build=$2; shift 2 ;;
        --blender) cycles=(--blender "$2"); shift 2 ;;
        --spp) spp=(--spp "$2"); shift 2 ;;
        -*) sed -n 's/^#   //p' "$0" >&2; exit 2 ;;
        *) scenes+=("$1"); shift ;;
    esac
done
woodcock=$build/tools/woodcock
ladder=data/scenes/ladder
out=build/ladder
if ((!${#scenes[@]})); then
    for file in "$ladder"/*.toml; do
        [[ $file == */sky_image.toml ]] || scenes+=("$(basename "$file" .toml)")
    done
fi

mkdir -p "$out"
bake() { # recipe, name, options
    [[ -e $out/$2.vdb ]] || "$woodcock" bake "$1" -o "$out/$2.vdb" -q "${@:3}" 2>/dev/null
}
bake "$ladder/recipes/constant.toml" constant --voxel 0.0625
bake "$ladder/recipes/ramp.toml" ramp --voxel 0.25
bake "$ladder/recipes/voxel.toml" voxel --voxel 0.5
bake "$ladder/recipes/colour.toml" colour --voxel 0.05
bake "$ladder/recipes/ball.toml" ball --voxel 0.05
bake "$ladder/recipes/fire.toml" fire --voxel 0.05
bake "$ladder/recipes/moving.toml" moving --voxel 0.05
bake cumulus cloud --resolution 96 --set size=2
# A luminaire without symmetry, in steps so fine that programs interpolate it alike.
awk 'BEGIN {
    pi = atan2(0, -1)
    print "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 73 73 1 2 0 0 0\n1 1 0"
    for (v = 0; v <= 180; v += 2.5) printf "%g ", v
    print ""
    for (h = 0; h <= 360; h += 5) printf "%g ", h
    for (h = 0; h <= 360; h += 5) {
        print ""
        for (v = 0; v <= 180; v += 2.5) {
            a = h * pi / 180; s = sin(v * pi / 180); c = cos(v * pi / 180)
            printf "%.3f ", 5 + 60 * exp(3 * (0.8 * c + 0.5 * s * cos(a) + 0.3 * s * sin(a) - 1))
        }
    }
}' > "$out/lobes.ies"
[[ -e $out/sky.exr ]] || "$woodcock" render "$ladder/sky_image.toml" -o "$out/sky.exr" -q

printf '%-12s %-20s %-28s %-24s %s\n' scene Cycles 'Cycles / Woodcock (r, g, b)' \
    'standard errors' verdict
failed=0
for scene in "${scenes[@]}"; do
    for seed in 1 2; do
        "$woodcock" render "$ladder/$scene.toml" -o "$out/$scene.$seed.exr" --seed $seed -q \
            "${spp[@]}"
        "$woodcock" cycles "$ladder/$scene.toml" -o "$out/$scene.cycles.$seed.exr" --seed $seed \
            "${cycles[@]}" "${spp[@]}" 2>"$out/$scene.log" || {
            grep -q 'is the first that has' "$out/$scene.log" || { cat "$out/$scene.log" >&2; exit 1; }
            printf '%-12s %s\n' "$scene" 'left out: this Blender has no such phase function'
            continue 2
        }
    done
    row=$("$build/tests/mean_ratio" "$out/$scene".{1,2}.exr "$out/$scene".cycles.{1,2}.exr) || failed=1
    how=$(sed -n 's/^info: Blender \(.*\): [0-9]* samples in \(.*\)$/\1 \2/p' "$out/$scene.log")
    printf '%-12s %-20s %s\n' "$scene" "$how" "$row"
done
exit $failed
