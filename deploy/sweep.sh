#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Many seeds of many scenarios through many estimators, on all cores, and one table of what came out.
#
# usage: deploy/sweep.sh SCENARIO... --out DIR [options]
#   --seeds LIST        e.g. 1-20 or 1,3,7-9 (default: 1-20)
#   --estimators LIST   rows of the table, NAME or NAME=ESTIMATOR:KEY=VALUE:..., separated by commas
#                       (default: odometry,waymark; ESTIMATOR is odometry, gmapping, marker_matching or waymark);
#                       e.g. no_ids=waymark:slam.blank_ids=true
#   --variants FILE     faults that are put into each recorded log, a row for each (waymark-faults --help)
#   --out DIR           where everything goes; the same command again goes on where it stopped
#   --jobs N            jobs at the same time (default: one per core)
#   --sshlogin LIST     machines, as GNU parallel takes them; DIR and this folder must be shared with them
#   --keep-images       record the camera's images, too (20 times the disk)
#   --plan-only         write the plan, and stop (deploy/sweep.slurm runs it on a cluster)
#
# A job records the log of one scenario and seed, live and in lockstep, replays every estimator on it and
# evaluates. A run that fails is a failure in the table and stops nobody; a full disk stops the sweep.
# Results: DIR/results.md, results.csv, runs.csv, index.html (the worst map of every row), plots/.
# Deletes, in DIR, the runs whose scenario, faults or programs' settings have changed and the rows whose estimator or
# settings have; slam.lcm of every row, and the logs that waymark-faults made, once they have been evaluated. Runs and
# rows that are no longer in the plan stay, and are not in the table.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# shellcheck source=deploy/lists.sh
source "$deploy_dir/lists.sh"

parse_arguments() {
  scenarios=() seeds=1-20 estimators=odometry,waymark variants='' out='' jobs=$(nproc) images=0
  plan_only='' parallel_options=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --keep-images) images=1 && shift && continue ;;
      --plan-only) plan_only=1 && shift && continue ;;
      --seeds | --estimators | --variants | --out | --jobs | --sshlogin) need_value "$@" ;;&
      --seeds) seeds=$2 ;;
      --estimators) estimators=$2 ;;
      --variants) need_file "$2" && variants=$2 ;;
      --out) out=$2 ;;
      --jobs) need_count "$1" "$2" && jobs=$2 ;;
      --sshlogin) parallel_options+=(--sshlogin "$2") ;;
      -*) usage_error "unknown option '$1'" ;;
      *) scenarios+=("$1") && shift && continue ;;
    esac
    shift 2
  done
  ((${#scenarios[@]} > 0)) || usage_error "no scenario given"
  [[ -n $out ]] || usage_error "--out is missing"
  expand_seeds
  expand_rows
}

# check_scenarios: each will have a folder beside the plan and the table.
check_scenarios() {
  local file name
  local -A seen=()
  for file in "${scenarios[@]}"; do
    need_file "$file"
    name=$(basename "${file%.toml}")
    [[ $name =~ ^[A-Za-z0-9_][A-Za-z0-9_.-]{0,99}$ ]] ||
      die $kExitUsage "'$name': names of scenarios are letters, digits, _ . -, at most 100, the first one no . or -"
    case $name in
      plan | plan.* | plots | results.* | runs.csv | index.html)
        die $kExitUsage "'$name': a sweep's folder has a '$name' of its own; give the scenario another name"
        ;;
    esac
    [[ ! -v seen[$name] ]] || die $kExitUsage "two scenarios are called '$name'"
    seen[$name]=1
  done
}

# write_plan: DIR/plan holds all that a job needs, so that it can be done alone and anywhere.
#   scenarios/NAME.toml, variants.toml   copies
#   rows        NAME ESTIMATOR KEY=VALUE... per line
#   variants    names, one per line
#   jobs        SCENARIO SEED per line
#   runs.tsv    scenario, seed, folder, row, command that does it again: for waymark-evaluate sweep
# It is made in plan.new, and takes the place of an earlier one (adopt_plan) when nothing can be wrong any more.
write_plan() {
  local file name seed
  plan=$out/plan.new
  trap 'rm -rf -- "$out/plan.new"' EXIT
  rm -rf -- "$plan"
  mkdir -p "$plan/scenarios"
  for file in "${scenarios[@]}"; do
    name=$(basename "${file%.toml}")
    "$bin_dir/waymark-sim" --config "$file" --dump-config >/dev/null || exit $?
    cp "$file" "$plan/scenarios/$name.toml"
    for seed in "${seed_list[@]}"; do echo "$name $seed"; done >>"$plan/jobs"
  done
  printf '%s\n' "${rows[@]}" >"$plan/rows"
  : >"$plan/variants"
  if [[ -n $variants ]]; then
    "$bin_dir/waymark-faults" --variants "$variants" --list >"$plan/variants" || exit $?
    cp "$variants" "$plan/variants.toml"
  fi
  echo "$images" >"$plan/images"
  write_runs
}

# find_old_plan: restores a plan whose replacement was interrupted; refuses a folder whose plan is
# not one of a sweep.
find_old_plan() {
  # Killed while its plans were changed.
  [[ -e $out/plan || ! -e $out/plan.old ]] || mv -T -- "$out/plan.old" "$out/plan"
  [[ ! -e $out/plan || -d $out/plan/scenarios ]] ||
    die $kExitUsage "'$out/plan' is no plan of a sweep; give another folder with --out"
}

adopt_plan() {
  rm -rf -- "$out/plan.old"
  [[ ! -e $out/plan ]] || mv -T -- "$out/plan" "$out/plan.old"
  mv -T -- "$plan" "$out/plan"
  plan=$out/plan
  rm -rf -- "$out/plan.old"
}

write_runs() {
  local name seed variant row rest again
  for name in $(cut -d ' ' -f 1 "$plan/jobs" | uniq); do
    for variant in '' $(cat "$plan/variants"); do
      while read -r row rest; do
        for seed in "${seed_list[@]}"; do
          again="$deploy_dir/sweep_job.sh $out $name $seed --again"
          printf '%s\t%s\t%s\t%s\t%s\n' "$name${variant:+"+$variant"}" "$seed" \
            "$name${variant:+"+$variant"}/seed-$seed" "$row" "$again"
        done
      done <"$plan/rows"
    done
  done >"$plan/runs.tsv"
}

# state_size: before anything runs. How long it takes, and whether the disk is enough, the jobs measure.
state_size() {
  local free_MB
  free_MB=$(df --output=avail -BM "$out" | tr -dc 0-9)
  say "${#scenarios[@]} scenarios x ${#seed_list[@]} seeds = $(wc -l <"$plan/jobs") logs," \
    "$(wc -l <"$plan/runs.tsv") runs of an estimator, $jobs at a time; what is done already is not done again"
  ((free_MB >= $(min_free_MB))) || die $kExitUsage "the disk of $out is full: $free_MB MB are free"
}

# run_jobs: 0 = all jobs have been done, well or not.
run_jobs() {
  local show=() name seed finished=0
  while read -r name seed; do
    [[ ! -e $out/$name/seed-$seed/finished ]] || finished=$((finished + 1))
  done <"$plan/jobs"
  echo "$EPOCHSECONDS $finished" >"$plan/start"
  [[ ! -t 2 ]] || show=(--bar)
  # In the background, so that a signal is heeded at once; with SIGINT as usual all the same.
  env --default-signal=INT parallel --will-cite --jobs "$jobs" --line-buffer --colsep ' ' \
    --halt soon,fail=1 --workdir "$out" "${show[@]}" "${parallel_options[@]}" \
    "$(printf '%q ' "$deploy_dir/sweep_job.sh" "$out")" '{1} {2} --count' :::: "$plan/jobs" </dev/null &
  parallel_pid=$!
  wait $parallel_pid
}

# on_signal NAME NUMBER
on_signal() {
  trap '' INT TERM HUP PIPE
  say "stopped by SIG$1; the same command goes on from here" || true  # whoever reads it may be gone
  [[ -z ${parallel_pid:-} ]] || kill -INT "$parallel_pid" 2>/dev/null || true
  wait
  exit $((128 + $2))
}

summarise() {
  "$bin_dir/waymark-evaluate" sweep "$out" --tolerant || die $? "no table"
  ! command -v gnuplot >/dev/null || (cd "$out/plots" && gnuplot plots.gp >plots.log 2>&1) || say "no plots; see $out/plots"
  say "table: $out/results.md, $out/results.csv; worst maps: $out/index.html"
}

parse_arguments "$@"
need_programs waymark-{sim,detector,slam,viewer,recorder,evaluate}
[[ -z $variants ]] || need_programs waymark-faults
command -v parallel >/dev/null || die $kExitUsage "GNU parallel is missing; install it with $deploy_dir/install-deps.sh --tests"
check_scenarios
# shellcheck disable=SC2119  # no settings of every row here
check_rows
out=$(make_folder "$out")
exec {sweep_lock}<"$out"
flock --nonblock "$sweep_lock" || die $kExitUsage "another sweep is writing to '$out'"
find_old_plan
write_plan
state_size
adopt_plan
[[ -z $plan_only ]] || exit 0
trap 'on_signal INT 2' INT
trap 'on_signal TERM 15' TERM
trap 'on_signal HUP 1' HUP
code=0
run_jobs || code=$kExitFailed
((code == 0)) || say "stopped before the end (see above); the same command goes on from here"
summarise
((code == 0)) || exit $code
