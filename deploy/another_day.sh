#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Maps the corridor, and localises in that map on another day: from a start drawn from the seed, facing the other
# way, with two markers gone, one moved and a new door.
#
# usage: deploy/another_day.sh [options]
#   --out DIR   (default: runs/another_day)
#   --seed N    of both days' errors, and of the start (default: 1)
#
# Writes DIR/mapping (a run that draws the map), DIR/corridor.map.lcm, DIR/localising (a run in that map), and prints
# the table of the second day, whose errors are in the map's frame (ate_frame_m in DIR/localising/results.json).
# Deletes an earlier run in both folders, and replaces the map.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

parse_arguments() {
  out=runs/another_day seed=1
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --out | --seed) need_value "$@" ;;&
      --out) out=$2 ;;
      --seed) need_number "$1" "$2" && seed=$2 ;;
      *) usage_error "unknown option '$1'" ;;
    esac
    shift 2
  done
}

# draw_start: writes the day's scenario with a start between 15 and 47 m.
draw_start() {
  local start_dm=$((150 + (seed * 7919) % 320))
  sed "s/^start_x_m = .*/start_x_m = $((start_dm / 10)).$((start_dm % 10))/" \
    "$deploy_dir/scenarios/another_day.toml" >"$out/another_day.toml"
}

parse_arguments "$@"
need_programs waymark-evaluate
out=$(make_folder "$out")
draw_start
map=$out/corridor.map.lcm
"$deploy_dir/launch.sh" "$deploy_dir/scenarios/corridor.toml" --seed "$seed" --out "$out/mapping" --save-map "$map"
"$deploy_dir/launch.sh" "$out/another_day.toml" --seed $((seed + 1)) --out "$out/localising" \
  --load-map "$map" --mode localise --start anywhere
"$bin_dir/waymark-evaluate" run "$out/localising" --mapped-in "$out/mapping"
