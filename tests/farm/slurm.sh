#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# slurm.sh [--install] [--short] WOODCOCK PIXEL_DIGEST [SEED]: `woodcock farm` against a real Slurm
# of this machine, which it starts and stops: tasks killed at random, a killed node daemon,
# preemption, a full queue, a bad frame among good ones, a cancelled job. Every picture must have
# the pixels of a render without a farm, and nothing may be done twice. Takes some ten minutes;
# --short takes one, and only kills tasks.
#
# Needs root. --install installs Slurm from Debian; without it, and without Slurm, the test is
# skipped (exit code 77).
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
. "$here/slurm_here.sh"
install=no short=no
while [[ ${1:-} == --* ]]; do
    case $1 in
        --install) install=yes ;;
        --short) short=yes ;;
        *) echo "unknown option $1" >&2 && exit 2 ;;
    esac
    shift
done
woodcock=$(realpath "$1") digest=$(realpath "$2")
RANDOM=${3:-1}

if ! has_slurm && [[ $install == no ]]; then
    echo "skipped: there is no slurmctld, slurmd, munged or sbatch; --install installs them"
    exit 77
fi
if ((EUID != 0)); then
    echo "skipped: Slurm's services are started as root"
    exit 77
fi
[[ $install == yes ]] && install_slurm

folder=$(mktemp -d)
chmod 755 "$folder"
services=$folder/services
end() {
    local code=$?
    [[ -z ${full:-} ]] || kill "$full" 2>/dev/null || true
    stop_slurm
    if ((code == 0)); then rm -rf "$folder"; else echo "failed; its files are in $folder" >&2; fi
}
trap end EXIT
trap 'exit 130' INT TERM

started=$SECONDS
tell() { printf '%4d s  %s\n' $((SECONDS - started)) "$*"; }
fail() {
    tell "FAILED: $*"
    exit 1
}

max_jobs=200
start_slurm
tell "Slurm $(sbatch --version | cut -d' ' -f2) runs: $(sinfo -h -o '%D node, %c processors')"
cd "$folder"

# ---- what is drawn

scene() { # scene SAMPLES: fog that grows denser from frame to frame
    cat <<SCENE
[[volume]]
box = { min = [-1, -1, -1], max = [1, 1, 1] }
scale = { keys = [[1, 0.5], [24, 3]] }
albedo = 0.8
[[light]]
type = "environment"
[camera]
eye = [2, 1, 4]
look_at = [0, 0, 0]
fov = 30
[render]
resolution = [48, 32]
spp = $1
SCENE
}
scene 2 >probe.toml
nanoseconds=$(date +%s%N)
"$woodcock" render probe.toml --threads 1 --spp 400 -o probe.exr --quiet
milliseconds=$((($(date +%s%N) - nanoseconds) / 1000000))
samples=$((2 * (400 * 1500 / milliseconds)))  # a part takes some 1.5 seconds
scene $samples >fog.toml
scene $((12 * samples)) >long.toml

pixels() { "$digest" "$1" | cut -d' ' -f1; }
submit() { "$woodcock" farm submit "$@" --threads 1 --checkpoint 0.3s --quiet; }
field() { # field JOB KEY...: a value of its status
    "$woodcock" farm status "$1" --json |
        python3 -c 'import json, sys
value = json.load(sys.stdin)
for key in sys.argv[1:]: value = value[int(key) if key.isdigit() else key]
print(value)' "${@:2}"
}
all_done() { [[ $(field "$1" all_done) == True ]]; }
queue_is_empty() { [[ -z $(squeue -h) ]]; }
node_is_down() { node_is 'down*' || node_is down; }
running_jobs() { squeue -h -r -t R -n "$1" -o %A; }
runs() { [[ -n $(running_jobs "$1") ]]; }
# Processes of a job; none where it is gone meanwhile. The render is a child of the runner, and that
# of the script.
processes_of() { # processes_of JOB render|runner|script|whole
    local pid words
    for pid in $(scontrol listpids "$1" 2>/dev/null | awk 'NR > 1 && $1 > 0 { print $1 }'); do
        words=$({ tr '\0' ' ' <"/proc/$pid/cmdline"; } 2>/dev/null) || continue
        case "$2 $words" in
            render\ "$woodcock render "* | runner\ "$woodcock farm run "* | \
                script\ */bin/sh\ *slurm_script* | whole\ "$woodcock "* | whole\ */bin/sh\ *)
                echo "$pid"
                ;;
        esac
    done
}

# No part and no picture was finished twice. What is killed just after it wrote its file, and before
# its end is noted, is drawn again: it does not count as finished.
check_once() { # check_once JOB PICTURES
    local log
    for log in "$1"/logs/*.log; do
        (($(grep -c '^--- .* exit code 0 after' "$log") <= 1)) || fail "finished twice: $log"
    done
    [[ $(field "$1" frames_merged) == "$2" ]] || fail "not all is merged"
    [[ -z $(ls "$1/parts") ]] || fail "parts are left: $(ls "$1/parts")"
}
check_pixels() { # check_pixels SCENE FRAMES NAME: NAME.####.exr are the pictures of one machine
    local frame
    "$woodcock" render "$1" --frames "$2" -o "single.####.exr" --quiet --skip-existing
    for frame in single.*.exr; do
        [[ $(pixels "$frame") == "$(pixels "${frame/single/$3}")" ]] || fail "$3: $frame differs"
    done
    rm single.*.exr
}

# ---- tasks that are killed

frames=24 victims=(render runner script whole whole)
if [[ $short == yes ]]; then frames=6 victims=(runner whole); fi
submit fog.toml --frames 1-$frames --parts 2 -o "a.####.exr" --job a.farm
tell "$frames frames in 2 parts are submitted"
at_least() { if [[ $1 == whole ]]; then echo 3; else echo 1; fi; }
kills=0
declare -A killed_jobs=()
for kind in "${victims[@]}"; do
    [[ $short == yes ]] || sleep "$((RANDOM % 3)).$((RANDOM % 10))"
    for ((attempt = 0; attempt < 1000; ++attempt)); do
        jobs=($(running_jobs a-render))
        if ((${#jobs[@]})); then
            job=${jobs[RANDOM % ${#jobs[@]}]}
            pids=($(processes_of "$job" $kind))
            if ((${#pids[@]} >= $(at_least $kind))) && [[ -z ${killed_jobs[$job]:-} ]] &&
                kill -9 "${pids[@]}" 2>/dev/null; then
                killed_jobs[$job]=1 kills=$((kills + 1))
                tell "killed ${kind/whole/all processes} of task $job"
                break
            fi
        fi
        sleep 0.3
    done
done
((kills == ${#victims[@]})) || fail "killed $kills tasks instead of ${#victims[@]}"
await 1200 all_done a.farm
await 600 queue_is_empty
check_once a.farm $frames
check_pixels fog.toml 1-$frames a
tell "$frames of $frames frames are done, with the pixels of one machine; $kills tasks killed, 0 parts" \
    "and 0 frames done twice; handed to Slurm $(grep -c '"array"' a.farm/slurm/submissions.json) times"

[[ $short == no ]] || exit 0

# ---- a queue that stays full: it takes Slurm two minutes to say so

submit probe.toml --frames 1-300 --job full.farm -o "full.####.exr" >full.out 2>&1 &
full=$!

# ---- a killed node daemon

submit fog.toml --frames 1-6 --parts 2 -o "b.####.exr" --job b.farm
await 120 runs b-render
kill_slurmd
tell "killed slurmd, while $(running_jobs b-render | wc -l) tasks ran"
await 120 node_is_down
tell "Slurm calls the node down"
start_slurmd
await 600 all_done b.farm
await 300 queue_is_empty
check_once b.farm 6
check_pixels fog.toml 1-6 b
tell "6 of 6 frames are done, with the pixels of one machine, nothing twice"

# ---- preemption

submit long.toml --frames 1-2 --parts 2 -o "c.####.exr" --job c.farm
checkpointed() { compgen -G "c.farm/parts/*.checkpoint.exr" >/dev/null; }
await 300 checkpointed
# As Slurm does before the limit of time. The last element is the one whose number is the array's.
scancel --batch --signal=TERM "$(squeue -h -r -t R -n c-render -o %i | sort | tail -1)"
requeued() {
    grep -q 'Z exit code 130 ' c.farm/logs/0002.1.log && [[ -n $(squeue -h -r -t PD -n c-render) ]]
}
await 120 requeued
tell "a task was told that its time is up, and is in the queue again"
sbatch -p high -n 4 -J high -o /dev/null --wrap "sleep 5" >/dev/null
high_ran() { [[ -z $(squeue -h -n high) ]]; }
await 300 high_ran
tell "a job of higher priority came between"
interruptions() { cat c.farm/logs/*.log | grep -c 'Z exit code 130 ' || true; }
(($(interruptions) > 0)) || fail "no task was interrupted"
await 900 all_done c.farm
await 300 queue_is_empty
check_once c.farm 2
resumed=$(cat c.farm/logs/*.log | grep -c '^info: goes on from')
((resumed > 0)) || fail "no task went on from its checkpoint"
check_pixels long.toml 1-2 c
tell "2 of 2 frames are done; $(interruptions) tasks were preempted, $resumed went on from" \
    "their checkpoints, nothing twice"

# ---- a bad frame among good ones

"$woodcock" bake smoke_column -o s.0001.vdb --resolution 16 --quiet
for frame in 2 3 4 5 6; do cp s.0001.vdb "s.000$frame.vdb"; done
echo "no VDB" >s.0004.vdb
cat >smoke.toml <<'SCENE'
[[volume]]
file = "s.####.vdb"
density = "density"
scale = 0.3
[[light]]
type = "environment"
radiance = 1
[camera]
eye = [-1, 18, 60]
look_at = [-1, 18, 0]
[render]
resolution = [32, 32]
spp = 16
SCENE
submit smoke.toml --frames 1-6 --parts 2 -o "d.####.exr" --job d.farm
await 120 queue_is_empty
[[ $(field d.farm frames_merged) == 5 ]] || fail "the good frames are not all there"
[[ $(field d.farm parts failed) == 2 && $(field d.farm troubles 0 attempts) == 1 ]] ||
    fail "the bad frame failed otherwise"
tell "5 of 6 frames are done; $(field d.farm troubles 0 what): $(field d.farm troubles 0 error)"
cp s.0001.vdb s.0004.vdb
"$woodcock" farm resubmit d.farm --quiet
await 300 all_done d.farm
await 120 queue_is_empty
check_once d.farm 6
check_pixels smoke.toml 1-6 d
tell "the frame was mended and submitted again: 6 of 6 frames are done, nothing twice"

# ---- cancelled, and gone on with

submit long.toml --frames 1-2 --parts 2 -o "e.####.exr" --job e.farm
await 120 runs e-render
"$woodcock" farm cancel e.farm --quiet
await 120 queue_is_empty
[[ $(field e.farm parts done) != 4 ]] || fail "it was done before it was cancelled"
"$woodcock" farm resubmit e.farm --quiet
await 900 all_done e.farm
await 300 queue_is_empty
check_once e.farm 2
check_pixels long.toml 1-2 e
tell "cancelled, submitted again: 2 of 2 frames are done, nothing twice"

# ---- the full queue

code=0
wait $full || code=$?
((code == 1)) || fail "a full queue ends with exit code $code"
grep -q "woodcock farm resubmit" full.out || fail "a full queue says: $(cat full.out)"
[[ $(field full.farm parts waiting) == 300 ]] || fail "a full queue changed the job"
tell "a queue with room for $max_jobs does not take 301: $(grep 'error: Slurm does' full.out)"
tell "all is as it should be"
