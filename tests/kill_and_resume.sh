#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kill_and_resume.sh WOODCOCK PIXEL_DIGEST [PICTURES [SEED]]: renders tiny pictures without
# interruption, then as often as PICTURES says with checkpoints, killed by SIGKILL at random times
# and resumed until they are done. Every picture must have the same pixels, and its deep pixels the
# same bytes. Says how often it killed.
set -euo pipefail

woodcock=$1 digest=$2 pictures=${3:-3}
RANDOM=${4:-1}
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
kills=0 resumed=0 picture=0
end() {
    echo "$picture pictures of the same pixels, $kills kills, $resumed of them after a resume"
    kill -9 ${process:-} 2>/dev/null || true
    rm -rf "$folder"
}
trap end EXIT
trap 'exit 130' INT TERM
cd "$folder"

cat "$here/tools/fog.toml" - >fog.toml <<'SCENE'
[[light]]
type = "sun"
direction = [1, -2, 0]
[[surface]]
name = "ball"
sphere = { radius = 0.4 }
SCENE

# Whether samples are spread evenly or by a plan, and what is kept beside the picture.
kinds=(even deep adaptive mattes)
declare -A options=(
    [even]="--no-adaptive"
    [deep]="--adaptive --mattes object --deep a_deep.exr"
    [adaptive]="--adaptive"
    [mattes]="--no-adaptive --mattes object,material --mattes-file a_mattes.exr --deep a_deep.exr")
# The same words always: headers repeat them.
render=("$woodcock" render fog.toml --quiet --res 40x30 --spp 800 --layers "depth,error,samples"
    -o a.exr --checkpoint 0.1s --resume)
outputs=(a.exr a_mattes.exr a_deep.exr)

# One line for each file that the render has written.
sums() {
    local file
    for file in "${outputs[@]}"; do
        if [[ ! -e $file ]]; then continue; fi
        if [[ $file == a_deep.exr ]]; then cksum "$file"; else "$digest" "$file"; fi
    done
}

declare -A expected takes
for ((picture = 0; picture < pictures; ++picture)); do
    kind=${kinds[picture % ${#kinds[@]}]}
    if [[ -z ${expected[$kind]:-} ]]; then
        start=$(date +%s%N)
        "${render[@]}" ${options[$kind]}
        # Milliseconds that it takes on this machine, which may be busy.
        takes[$kind]=$((($(date +%s%N) - start) / 1000000 + 1))
        expected[$kind]=$(sums)
        rm -f "${outputs[@]}"
    fi
    for ((attempt = 0; ; ++attempt)); do
        there=no
        if [[ -e a.checkpoint.exr ]]; then there=yes; fi
        # Not by a function: its process would be a shell's, whose death spares the program.
        "${render[@]}" ${options[$kind]} &
        process=$!
        # More patience each time, on a machine that may have become slower.
        pause=$((RANDOM % (takes[$kind] / 4 + 1) + takes[$kind] * (1 + attempt) / 16))
        sleep "$((pause / 1000)).$(printf %03d $((pause % 1000)))"
        kill -9 $process 2>/dev/null || true
        code=0
        wait $process 2>/dev/null || code=$?
        if ((code == 137)); then
            kills=$((kills + 1))
            if [[ $there == yes ]]; then resumed=$((resumed + 1)); fi
        elif ((code != 0)); then
            echo "picture $picture ($kind): exit code $code after $kills kills" >&2
            exit 1
        else
            break
        fi
    done
    if [[ $(sums) != "${expected[$kind]}" ]]; then
        echo "picture $picture ($kind) differs after $kills kills" >&2
        exit 1
    fi
    if compgen -G '.woodcock*' >/dev/null || [[ -e a.checkpoint.exr ]]; then
        echo "files are left: $(ls -a)" >&2
        exit 1
    fi
    rm -f "${outputs[@]}"
done
