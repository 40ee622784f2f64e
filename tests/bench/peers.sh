#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Compares what a noise costs Woodcock, Blender's Cycles and Mitsuba 3 on the scenes of
# tests/bench/scenes, in one sitting, and prints a table in Markdown.
#
#   tests/bench/peers.sh [--quick] [--assets DIRECTORY] [--woodcock PROGRAM] [--scratch DIRECTORY]
#                        [--threads N] [--clock wall|processor] [SCENE ...]
#
# --quick      a quarter of the samples
# --assets     holds teapot_cloud.vdb and fire_0045.vdb, which are not part of the project. Without
#              it, stand-ins are baked, whose numbers are others
# --woodcock   without it, the program that tools/demo.sh builds
# --scratch    where the peers are installed, and pictures drawn (build/peers); 1.5 GB
# --threads    of each renderer, all on the same cores (as many as there are cores)
# --clock      processor: seconds of the processor, for a machine that has other work
# SCENE        thin, cloud, chromatic, overlap, fire, tea, lamp; without any: all
#
# The peers come from PyPI, and bpy needs Python 3.11. Mitsuba's LLVM is unpacked from Debian's
# package libllvm19. Nothing needs root.
# Exit code 1: some pictures do not show the same scene.
set -euo pipefail
self=$(realpath "$0")

usage() { sed -n '/^# Compares/,/^# Exit/s/^# \{0,1\}//p' "$self"; }
top=${self%/tests/bench/*}
quick=() assets='' woodcock=$top/build/demo/tools/woodcock scratch=$top/build/peers clock=wall
threads=$(nproc)
scenes=()
while (($#)); do
    case $1 in
        --help | -h) usage; exit 0 ;;
        --quick) quick=(--quick); shift ;;
        --assets) assets=$(realpath "${2:?}"); shift 2 ;;
        --woodcock) woodcock=$(realpath -m "${2:?}"); shift 2 ;;
        --scratch) scratch=$(realpath -m "${2:?}"); shift 2 ;;
        --threads) threads=${2:?}; shift 2 ;;
        --clock) clock=${2:?}; shift 2 ;;
        -*) usage >&2; exit 2 ;;
        *) scenes+=("$1"); shift ;;
    esac
done
fail() { echo "peers.sh: $1" >&2; exit 2; }
[[ -x $woodcock ]] ||
    fail "there is no $woodcock; build it by tools/demo.sh, or name another by --woodcock"
mkdir -p "$scratch"
cd "$top"

# The peers, each in an environment of its own: they need different versions of NumPy.
environment() { # name, packages
    [[ -e $scratch/$1/installed ]] && return
    echo "installing ${*:2}" >&2
    python3.11 -m venv --clear "$scratch/$1" || fail 'the peers need Python 3.11 (with venv)'
    "$scratch/$1/bin/pip" install --quiet --disable-pip-version-check "${@:2}" >&2
    touch "$scratch/$1/installed"
}
environment cycles bpy==5.0.1
environment mitsuba mitsuba==3.9.1 numpy OpenImageIO
# Mitsuba's compiler needs LLVM 16 or newer.
if [[ ! ${DRJIT_LIBLLVM_PATH:-} ]]; then
    library=$scratch/llvm/usr/lib/$(uname -m)-linux-gnu/libLLVM.so.19.1
    if [[ ! -e $library ]]; then
        mkdir -p "$scratch/llvm"
        (cd "$scratch/llvm" && apt-get -qq download libllvm19 && dpkg -x libllvm19_*.deb .) >&2 ||
            fail 'Mitsuba needs LLVM, such as Debian'\''s libllvm19; DRJIT_LIBLLVM_PATH may name it'
    fi
    export DRJIT_LIBLLVM_PATH=$library
fi

# The scenes, with their volumes beside them.
drawn=$scratch/scenes
mkdir -p "$drawn"
cp tests/bench/scenes/*.toml "$drawn"
volume() { # name, asset, options of the bake
    rm -f "$drawn/$1.vdb" "$drawn/$1.vol"
    if [[ $assets ]]; then
        [[ -e $assets/$2 ]] || fail "$assets has no $2"
        ln -s "$assets/$2" "$drawn/$1.vdb"
    else
        "$woodcock" bake "tests/bench/scenes/recipes/$1.toml" -o "$drawn/$1.vdb" -q "${@:3}"
    fi
}
volumes='stand-ins, baked from tests/bench/scenes/recipes'
[[ ! $assets ]] || volumes='teapot_cloud.vdb, fire_0045.vdb'
volume cloud teapot_cloud.vdb --resolution 266
volume fire fire_0045.vdb --resolution 126
"$woodcock" convert "$drawn/cloud.vdb" "$drawn/cloud.vol" -q

export PYTHONDONTWRITEBYTECODE=1
exec taskset -c "0-$((threads - 1))" "$scratch/mitsuba/bin/python" tests/bench/peers/compare.py \
    --woodcock "$woodcock" --cycles "$scratch/cycles/bin/python" \
    --mitsuba "$scratch/mitsuba/bin/python" --scenes "$drawn" --threads "$threads" \
    --volumes "$volumes" --clock "$clock" "${quick[@]}" "${scenes[@]}"
