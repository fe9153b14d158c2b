# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the tests of deploy/'s scripts: an installed layout with fake programs, what is expected of a
# script, and run_cases. A case is a function in lower case without arguments.
set -euo pipefail

unset CDPATH
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export FAKE_DIR=$work
unset LCM_DEFAULT_URL

# The installed layout, with one fake program under all names.
deploy=$work/share/waymark/deploy
mkdir -p "$work/bin" "$work/share/waymark"
cp -r "$source_dir/deploy" "$deploy"
cp "$source_dir/tests/process/fake_program.sh" "$work/bin/waymark-sim"
for name in detector slam viewer recorder evaluate faults import; do ln -s waymark-sim "$work/bin/waymark-$name"; done
scenario=$work/short.toml
touch "$scenario"
# shellcheck disable=SC2034  # for the cases
out=$work/run
output=$work/output

fail() {
  echo "FAILED: $*; the script's output:" >&2
  cat "$output" >&2
  exit 1
}

# expect CODE SCRIPT ARGUMENTS...
expect() {
  local expected=$1 script=$deploy/$2 code=0
  shift 2
  "$script" "$@" >"$output" 2>&1 || code=$?
  ((code == expected)) || fail "exit code $code instead of $expected from: ${script##*/} $*"
}

expect_output() { grep -qE -- "$1" "$output" || fail "no line like '$1'"; }

nothing_left() {
  local pid
  while read -r pid; do
    grep -qsE '^State:\s+Z' "/proc/$pid/status" || [[ ! -d /proc/$pid ]] || return 1
  done <"$work/pids"
}

expect_nothing_left() { nothing_left || fail "a process is left of: $(tr '\n' ' ' <"$work/pids")"; }

# wait_until COMMAND...: for at most a minute.
wait_until() {
  local i
  for ((i = 0; i < 1200; ++i)); do
    "$@" && return
    sleep 0.05
  done
  fail "waited in vain for: $*"
}

all_started() { [[ -e $work/pids ]] && (($(wc -l <"$work/pids") >= 5)); }

all_cases() { sed -nE 's/^([a-z_]+)\(\) \{$/\1/p' "$0" | grep -vxE '[a-z_]+_of_case'; }

# run_cases [--list | CASE...]: all without arguments.
run_cases() {
  if (($# == 0)); then
    mapfile -t cases < <(all_cases)
    set -- "${cases[@]}"
  fi
  [[ $1 != --list ]] || { all_cases && return; }
  if (($# == 1)); then
    declare -F "$1" >/dev/null || { echo "no case '$1'" >&2 && exit 2; }
    "$1"
    return
  fi
  failed=0
  for name in "$@"; do
    if "$0" "$name"; then echo "ok     $name"; else echo "FAILED $name" && failed=1; fi
  done
  exit $failed
}
