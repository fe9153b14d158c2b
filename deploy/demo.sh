#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The whole thing on a machine with nothing installed: packages, build, one drive through the corridor,
# its log through every estimator, and the paper's table; then the programs that the table did not need.
#
# usage: deploy/demo.sh [options]
#   --out DIR        where everything goes (default: runs/demo-SCENARIO)
#   --scenario FILE  (default: deploy/scenarios/corridor.toml, 50 m)
#   --seed N         seed of everything random (default: the scenario's run.seed)
#   --live           the drive as a live page at http://127.0.0.1:8080/ while it goes on
#   --fast           deploy/scenarios/corridor_fast.toml: 10 m, driven faster than the real robot can
#
# Installs Debian packages (as root). Deletes an earlier run in the --out folder, with the rows of all replays of it.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# The rows of the table: folder, estimator, and what is set differently (key=value or a file of deploy/).
rows=(
  "odometry odometry"
  "gmapping gmapping gmapping/slam_gmapping.toml"
  "gmapping_turtlebot3 gmapping gmapping/turtlebot3.toml"
  "marker_matching_no_ids marker_matching slam.blank_ids=true"
  "marker_matching_rotation_only marker_matching slam.motion.rotation_only=true"
  "marker_matching marker_matching"
  "waymark_no_ids waymark slam.blank_ids=true"
  "waymark waymark"
)
readonly live_estimator=waymark

parse_arguments() {
  out='' scenario='' seed=() live_page=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --fast) scenario=$deploy_dir/scenarios/corridor_fast.toml && shift && continue ;;
      --live) live_page=(--http 127.0.0.1:8080) && shift && continue ;;
      --out | --scenario | --seed) need_value "$@" ;;&
      --out) out=$2 ;;
      --scenario) scenario=$2 ;;
      --seed) need_number "$1" "$2" && seed=(--seed "$2") ;;
      *) usage_error "unknown option '$1'" ;;
    esac
    shift 2
  done
  scenario=${scenario:-$deploy_dir/scenarios/corridor.toml}
  need_file "$scenario"
  out=$(make_folder "${out:-runs/demo-$(basename "${scenario%.toml}")}")
}

step_names=() step_seconds=()

# step NAME COMMAND...
step() {
  local name=$1 start=$SECONDS
  shift
  say "== $name"
  "$@" || die $? "the step '$name' failed"
  step_names+=("$name") step_seconds+=($((SECONDS - start)))
}

# fingerprint: of the files that live run and replay must have in common, byte for byte.
fingerprint() { (cd "$out/$live_estimator" && sha256sum map.pgm trajectory.tum); }

# replay_row ROW: its output is printed only if it fails.
replay_row() {
  local name estimator settings setting options=() output start=$SECONDS
  read -r name estimator settings <<<"$1"
  for setting in $settings; do
    case $setting in
      *.toml) options+=(--config "$deploy_dir/$setting") ;;
      *) options+=(--set "$setting") ;;
    esac
  done
  if output=$("$deploy_dir/replay.sh" "$out/run.lcm" --estimator "$estimator" --row "$name" "${options[@]}" 2>&1); then
    say "replayed $name, $((SECONDS - start)) s"
  else
    printf '%s\n' "$output" >&2
    die $kExitFailed "the replay of $name failed"
  fi
}

# replay_rows: as many at a time as there are cores.
replay_rows() {
  export deploy_dir out script_name kExitFailed
  export -f replay_row say die
  # shellcheck disable=SC2016  # for the inner shell
  printf '%s\0' "${rows[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'replay_row "$1"' replay_row || return $kExitFailed
}

report_times() {
  local i
  say "seconds per step"
  for i in "${!step_names[@]}"; do printf '%8d  %s\n' "${step_seconds[i]}" "${step_names[i]}"; done
}

parse_arguments "$@"
step "install packages" "$deploy_dir/install-deps.sh"
step "build" build release waymark-{sim,detector,slam,viewer,recorder,evaluate}
step "drive" "$deploy_dir/launch.sh" "$scenario" --out "$out" --estimator $live_estimator "${seed[@]}" "${live_page[@]}"
live=$(fingerprint)
step "replay" replay_rows
[[ $live == "$(fingerprint)" ]] ||
  die $kExitFailed "live run and replay of its log differ in $live_estimator/map.pgm or trajectory.tum"
step "evaluate" "$bin_dir/waymark-evaluate" run "$out"
[[ -z $source_dir ]] || say "the table is ready; now the programs that it did not need"
step "build the other programs" build release programs
report_times
say "live run and replay of its log: the same map and trajectory, byte for byte"
say "pictures: $out/*/map.png; table: $out/results.md"
