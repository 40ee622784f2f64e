#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Holds two programs to the same bits: both bake the same volumes and render the same scenes, with
# the same seed and samples, and every voxel and pixel must be equal. Run it before and after you
# change code that should change no picture.
#   tests/same_bits.sh BEFORE AFTER PIXEL_DIGEST
# BEFORE and AFTER are two `woodcock` programs, PIXEL_DIGEST is tests/programs/pixel_digest.
# Prints a digest for each volume and picture. Exit 1 where one differs.
set -euo pipefail
[[ $# -eq 3 ]] || { sed -n '3,8s/^# \?//p' "$0" >&2; exit 2; }
before=$(realpath "$1") after=$(realpath "$2") digest=$(realpath "$3")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch"/{before,after}

# [spp=SAMPLES] draw NAME INPUT [ARGUMENT...]: by both programs.
draw() {
    local name=$1 input=$2 program
    shift 2
    for program in before after; do
        "${!program}" render "$input" -o "$scratch/$program/$name.exr" --res 64x48 --spp "${spp:-4}" \
            --log-level error "$@"
    done
}

for program in before after; do
    for recipe in cumulus explosion coloured_smoke; do
        "${!program}" bake $recipe --resolution 64 -o "$scratch/$program/$recipe.vdb" --quiet
    done
    (cd "$scratch/$program" && sha256sum ./*.vdb) >"$scratch/$program.digests"
done
cloud=$scratch/before/cumulus.vdb
fire=$scratch/before/explosion.vdb
inCloud=(--set "volume[0].file=$cloud")
inFire=(--set "volume[0].file=$fire")
scenes=data/scenes

draw file "$cloud"
draw grey $scenes/sky.toml "${inCloud[@]}"
draw droplets $scenes/demo.toml "${inCloud[@]}"
draw chromatic $scenes/chromatic.toml "${inCloud[@]}"
draw colour_grids $scenes/coloured_smoke.toml \
    --set "volume[0].file=$scratch/before/coloured_smoke.vdb"
draw overlapping $scenes/overlap.toml "${inCloud[@]}" --set "volume[1].file=$cloud"
draw fire $scenes/fire.toml "${inFire[@]}"
draw ground $scenes/ground.toml "${inCloud[@]}"
for scene in box_of_fog gems glass tea window; do draw $scene $scenes/$scene.toml; done
draw local_lights_in_fog $scenes/ladder/local_lights.toml
draw layers $scenes/tea.toml --layers depth,albedo,normal,transmittance,samples,error,variance
for quality in draft preview final reference; do
    draw "quality_$quality" $scenes/sky.toml "${inCloud[@]}" --quality $quality
done
draw marched $scenes/sky.toml "${inCloud[@]}" --set render.march_step=1
draw marched_fire $scenes/fire.toml "${inFire[@]}" --set render.march_step=1
draw exponential_steps $scenes/sky.toml "${inCloud[@]}" --set render.march_step=1 \
    --set render.march_estimate=exponential
spp=64 draw adaptive $scenes/sky.toml "${inCloud[@]}" --adaptive
draw similarity $scenes/sky.toml "${inCloud[@]}" --set render.similarity_after=2
draw octaves $scenes/sky.toml "${inCloud[@]}" --set render.octaves=4
draw clamped $scenes/fire.toml "${inFire[@]}" --set render.clamp=2
draw nearest $scenes/sky.toml "${inCloud[@]}" --set render.lookup=nearest
draw level_of_detail $scenes/sky.toml "${inCloud[@]}" --set render.level_of_detail=40
draw fixed8 $scenes/sky.toml "${inCloud[@]}" --storage fixed8

for program in before after; do
    (cd "$scratch/$program" && "$digest" ./*.exr) >>"$scratch/$program.digests"
done
cat "$scratch/after.digests"
if ! diff "$scratch/before.digests" "$scratch/after.digests" >"$scratch/difference"; then
    echo "These have other bits before (<) than after (>):"
    cat "$scratch/difference"
    exit 1
fi
echo "$(wc -l <"$scratch/after.digests") volumes and pictures have the same bits."
