#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Tests the tests: builds a copy of the sources with one deliberate defect after another and reports
# what catches each, a unit test and a case of `woodcock verify --quick`. Exit 1 if one survives.
#   tests/mutations/run.sh            all of list.sh
#   tests/mutations/run.sh TEXT...    those whose name contains one of the texts
#   tests/mutations/run.sh --check    none: looks only whether their lines are still there
set -uo pipefail
repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
checkOnly=
[[ ${1-} == --check ]] && checkOnly=1 && shift
wanted=("$@")
fail() { echo "mutations: $*" >&2; exit 2; }

chosen() {
    [[ ${#wanted[@]} -eq 0 ]] && return 0
    local text
    for text in "${wanted[@]}"; do [[ $1 == *"$text"* ]] && return 0; done
    return 1
}

# defect NAME TESTS CHECKS FILE OLD NEW: replaces OLD, which FILE must hold just once. TESTS: a
# filter of unit tests; CHECKS: for verify --only, or empty where the proof does not look.
# First all lines are looked for: code that moved must not cost an hour.
chosenCount=0
allTests=
allChecks=()
defect() {
    chosen "$1" || return 0
    local text rest
    text=$(cat "$repo/$4") || fail "$1: no file $4"
    rest=${text/"$5"/}
    [[ $rest != "$text" ]] || fail "$1: $4 no longer holds: $5"
    [[ ${rest/"$5"/} == "$rest" ]] || fail "$1: $4 holds more than once: $5"
    chosenCount=$((chosenCount + 1))
    [[ :$allTests: == *":$2:"* ]] || allTests+=${allTests:+:}$2
    [[ -z $3 || " ${allChecks[*]} " == *" $3 "* ]] || allChecks+=("$3")
}
source "$repo/tests/mutations/list.sh"
[[ -z $checkOnly ]] || { echo "$chosenCount defects"; exit 0; }
[[ $chosenCount -gt 0 ]] || fail "no defect's name contains ${wanted[*]}"

copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
trap 'exit 130' INT TERM

build() {
    cmake --build "$copy/build/release" --target woodcock_tests woodcock_program woodcock_verify_program \
        >"$copy/build.log" 2>&1
}

(cd "$repo" && git ls-files -z --cached --others --exclude-standard |
    xargs -0 cp --parents -t "$copy") || fail "cannot copy the sources"
echo "building a copy, and testing it without defects" >&2
(cd "$copy" && cmake --preset release) >"$copy/build.log" 2>&1 && build ||
    { cat "$copy/build.log"; fail "the sources do not build"; }

# The first unit test of a filter that fails, or why the tests ended without one.
unitTest() {
    local code=0
    timeout "$2" "$copy/build/release/tests/woodcock_tests" --gtest_fail_fast \
        --gtest_filter="$1:-*Proof*" >"$copy/tests.log" 2>&1 || code=$?
    [[ $code -ne 124 ]] || { echo "(time out)"; return; }
    [[ $code -le 128 ]] || { echo "(crash)"; return; }
    grep -q '\[==========\] [1-9][0-9]* test' "$copy/tests.log" || fail "no test is called $1"
    sed -nE '/^\[  FAILED  \] /{s/.*\] ([^ ,]+).*/\1/p;q}' "$copy/tests.log"
}

# The first case that does not pass of the checks whose names contain $1.
proofCase() {
    [[ -n $1 ]] || return 0
    local code=0
    timeout 300 "$copy/build/release/tools/woodcock" verify --quick --json --only "$1" \
        >"$copy/verify.json" 2>"$copy/verify.log" || code=$?
    [[ $code -ne 124 ]] || { echo "(time out)"; return; }
    [[ $code -le 128 ]] || { echo "(crash)"; return; }
    [[ $code -le 1 ]] || { cat "$copy/verify.log" >&2; fail "verify --only '$1' does not work"; }
    awk -F '": "' '/"case":/ {name = $2; sub(/",$/, "", name)}
        /"verdict":/ && !/"pass"/ {print name; exit}' "$copy/verify.json"
}

# What fails by itself tells nothing.
byTest=$(unitTest "$allTests" 1800) || exit 2
[[ -z $byTest ]] || fail "without any defect, this fails: $byTest"
for check in ${allChecks[@]+"${allChecks[@]}"}; do
    byCase=$(proofCase "$check") || exit 2
    [[ -z $byCase ]] || fail "without any defect, this case fails: $byCase"
done

survivors=()
printf '%-44s | %-52s | %s\n' defect "unit test" "case of verify"
printf -- '-%.0s' {1..140}; echo

defect() {
    local name=$1 tests=$2 checks=$3 file=$copy/$4 old=$5 new=$6
    chosen "$name" || return 0
    local text byTest= byCase=
    text=$(cat "$file"; echo x)
    text=${text%x}
    printf '%s' "${text/"$old"/"$new"}" >"$file"
    if build; then
        byTest=$(unitTest "$tests" 300) || exit 2
        byCase=$(proofCase "$checks") || exit 2
    else
        tail -30 "$copy/build.log" >&2
        name+=" (DOES NOT BUILD)"
    fi
    printf '%s' "$text" >"$file"
    [[ -n $byTest || -n $byCase ]] || survivors+=("$name")
    printf '%-44s | %-52s | %s\n' "$name" "${byTest:--}" "${byCase:--}"
}
source "$repo/tests/mutations/list.sh"

echo
echo "$chosenCount defects, ${#survivors[@]} survive"
for name in ${survivors[@]+"${survivors[@]}"}; do echo "  $name"; done
[[ ${#survivors[@]} -eq 0 ]]
