#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# kill_and_resume.sh WOODCOCK PIXEL_DIGEST [PICTURES [SEED]]: renders a tiny picture without
# interruption, then as often as PICTURES says with checkpoints, killed by SIGKILL at random times
# and resumed until it is done. Every picture must have the same pixels. Says how often it killed.
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
SCENE

# Whether samples are spread evenly or by a plan.
declare -A options=([even]="--no-adaptive" [adaptive]="--adaptive")
render=("$woodcock" render fog.toml --quiet --res 40x30 --spp 800 --layers "depth,error,samples")
pixels() { "$digest" "$1" | cut -d' ' -f1; }

declare -A expected
start=$(date +%s%N)
for kind in even adaptive; do
    "${render[@]}" ${options[$kind]} -o "$kind.exr"
    expected[$kind]=$(pixels "$kind.exr")
done

# Milliseconds that a render takes on this machine, which may be busy.
takes=$((($(date +%s%N) - start) / 2000000))
for ((picture = 0; picture < pictures; ++picture)); do
    if ((picture % 2)); then kind=adaptive; else kind=even; fi
    rm -f a.exr
    while true; do
        there=no
        if [[ -e a.checkpoint.exr ]]; then there=yes; fi
        # Not by a function: its process would be a shell's, whose death spares the program.
        "${render[@]}" ${options[$kind]} -o a.exr --checkpoint 0.1s --resume &
        process=$!
        pause=$((RANDOM % takes + takes / 8))
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
        fi
        [[ -e a.exr ]] && break
    done
    # Killed after the picture was written and before its checkpoint was removed.
    if [[ -e a.checkpoint.exr ]]; then "${render[@]}" ${options[$kind]} -o a.exr --resume; fi
    if [[ $(pixels a.exr) != "${expected[$kind]}" ]]; then
        echo "picture $picture ($kind) differs after $kills kills" >&2
        exit 1
    fi
    if compgen -G '.woodcock*' >/dev/null; then
        echo "temporary files are left: $(ls -a)" >&2
        exit 1
    fi
done
