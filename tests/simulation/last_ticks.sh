#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Live lockstep runs of a short corridor that end at successive ticks, so that the last scan, map and marker map fall
# on every phase of their periods. Every run must end with code 0, at a tick of its own. Takes minutes: no part of
# tests/run.sh.
#
# usage: tests/simulation/last_ticks.sh [options]
#   --deploy DIR   the scripts, of a source tree that is built or installed (default: deploy/ of this tree)
#   --out DIR      (default: a temporary folder, deleted at the end if all is well)
#   --runs N       (default: 40, two seconds of ticks beyond the periods of scan and map)
#   --long         instead one run of a 12 m corridor at 0.25 m/s, whose last scan falls on a full period of the map
#
# Deletes earlier runs of its own in DIR.
set -euo pipefail

unset CDPATH
deploy_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../deploy" && pwd)
out='' runs=40 single=''
while (($# > 0)); do
  case $1 in
    --help | -h) sed -nE '3,/^set/{/^set/q; s/^# ?//p}' "$0" && exit 0 ;;
    --deploy) deploy_dir=$(cd "$2" && pwd) && shift 2 ;;
    --out) out=$2 && shift 2 ;;
    --runs) runs=$2 && shift 2 ;;
    --long) single=1 && shift ;;
    *) echo "last_ticks: unknown option '$1' (see --help)" >&2 && exit 2 ;;
  esac
done
temporary=
[[ -n $out ]] || { out=$(mktemp -d) && temporary=1; }
mkdir -p "$out"
failed=0
declare -A ends=()

# run NAME: one live run of $out/NAME.toml.
run() {
  local name=$1 code=0 end=
  "$deploy_dir/launch.sh" "$out/$name.toml" --no-images --out "$out/$name" >"$out/$name.log" 2>&1 || code=$?
  [[ ! -f $out/$name/truth.tum ]] || end=$(tail -1 "$out/$name/truth.tum" | cut -d ' ' -f 1)
  echo "$name: code $code, last true pose at ${end:--} s"
  ((code == 0)) || failed=$((failed + 1))
  [[ -z $end ]] || ends[$end]=1
}

if [[ -n $single ]]; then
  runs=1
  printf '[world]\nlength_m = 12.0\n[markers]\nlast_m = 10.0\n[route]\nend_x_m = 10.0\nspeed_mps = 0.25\n' \
    >"$out/corridor_12m.toml"
  run corridor_12m
else
  for ((k = 0; k < runs; ++k)); do
    name=$(printf 'end_%02d' "$k")
    printf '[world]\nlength_m = 5.0\n[markers]\nfirst_m = 2.0\nspacing_m = 2.0\nlast_m = 4.0\n[route]\nend_x_m = 2.0\nspeed_mps = 0.25\nsettle_s = %d.%d\n' \
      $((1 + k / 10)) $((k % 10)) >"$out/$name.toml"
    run "$name"
  done
fi
echo "$((runs - failed)) of $runs runs ended with code 0, at ${#ends[@]} different ticks"
((failed == 0 && ${#ends[@]} == runs)) || exit 1
[[ -z $temporary ]] || rm -rf -- "$out"
