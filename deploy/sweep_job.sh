#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# One job of a sweep: records one scenario and seed, replays every estimator on the log, evaluates.
#
# usage: deploy/sweep_job.sh DIR SCENARIO SEED [--again] [--count]
#   DIR       of deploy/sweep.sh, which has written the plan
#   --again   also what has been done already; afterwards the sweep's table is made anew
#   --count   say how many of the sweep's jobs are done, and how long the others will take
#
# What is done is marked by files that appear by renaming, so that a job may be killed at any time.
# Exit code 0 also when a run failed (its row's or folder's file `failed` says how, and the table does);
# 1 when no job can do any better: a full disk.
# Deletes what it makes anew: with --again the whole run of that scenario and seed with its faulty variants, else runs
# and rows whose plan has changed; and slam.lcm of each row once it is evaluated.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

parse_arguments() {
  again='' count='' words=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --again) again=1 ;;
      --count) count=1 ;;
      -*) usage_error "unknown option '$1'" ;;
      *) words+=("$1") ;;
    esac
    shift
  done
  ((${#words[@]} == 3)) || usage_error "a sweep's folder, a scenario's name and a seed, please"
  [[ -f ${words[0]}/plan/jobs ]] || die $kExitUsage "no plan in '${words[0]}'; make one with deploy/sweep.sh"
  sweep=$(cd "${words[0]}" && pwd) scenario=${words[1]} seed=${words[2]}
  plan=$sweep/plan
  grep -qxF "$scenario $seed" "$plan/jobs" || die $kExitUsage "no job '$scenario $seed' in $plan/jobs"
  base=$sweep/$scenario/seed-$seed
}

# check_disk: a full disk is nobody's failure but the sweep's.
check_disk() {
  local free_MB
  free_MB=$(df --output=avail -BM "$sweep" | tr -dc 0-9)
  ((free_MB >= $(min_free_MB))) ||
    die $kExitFailed "the disk of $sweep is full: $free_MB MB are free; make room and give the sweep's command again"
}

# fails FOLDER SENTENCE
fails() {
  check_disk
  put_text "$1/failed" "$2"
  say "$scenario seed $seed: $2"
}

# stamp FILE...: tells whether what was made from the files is still right.
stamp() { cat "$@" | sha256sum | cut -c 1-16; }

# leave_if_told CODE: a program that was told to stop has not failed, and the job is to stop, too.
leave_if_told() {
  case $1 in
    129 | 130 | 143) exit "$1" ;;  # SIGHUP, SIGINT, SIGTERM
  esac
}

# expectation: what the plan's scenario expects; no recording depends on it, so it may change later.
expectation() { awk '/^\[/ { inside = $0 ~ /^\[expect\]/ } inside' "$plan/scenarios/$scenario.toml"; }

# world: what the recorded log depends on.
world() {
  awk '/^\[/ { inside = $0 ~ /^\[expect\]/ } !inside && NF && !/^#/' "$plan/scenarios/$scenario.toml"
  cat "$plan/images"
}

# record: the log of the scenario, unless it is there.
record() {
  local images=() wanted code=0
  wanted=$(stamp <(world))
  if [[ $(cat "$base/recorded" 2>/dev/null) == "$wanted" ]]; then
    put_text "$base/expect.toml" "$(expectation)"
    return 0
  fi
  rm -rf -- "$base"
  mkdir -p "$base"
  [[ $(cat "$plan/images") == 1 ]] || images=(--no-images)
  "$deploy_dir/launch.sh" "$plan/scenarios/$scenario.toml" --seed "$seed" --record-only "${images[@]}" \
    --out "$base" >"$base.launch.log" 2>&1 || code=$?
  mkdir -p "$base/logs"
  mv "$base.launch.log" "$base/logs/sweep.log"
  leave_if_told $code
  if ((code != 0)); then
    fails "$base" "recording ended with code $code; logs are in $base/logs, the first words in sweep.log"
    return 1
  fi
  put_text "$base/expect.toml" "$(expectation)"
  put_text "$base/recorded" "$wanted"
}

# inject FOLDER VARIANT: the recorded run with faults, as a run folder of its own.
inject() {
  local wanted code=0
  wanted=$(stamp "$base/recorded" "$plan/variants.toml")
  [[ $(cat "$1/recorded" 2>/dev/null) != "$wanted" ]] || [[ -n $(rows_to_do "$1") && ! -e $1/run.lcm ]] || return 0
  [[ $(cat "$1/recorded" 2>/dev/null) == "$wanted" ]] || rm -rf -- "$1"
  mkdir -p "$1/logs"
  "$bin_dir/waymark-faults" "$base" --variants "$plan/variants.toml" --variant "$2" --out "$1" \
    >"$1/logs/faults.log" 2>&1 || code=$?
  leave_if_told $code
  if ((code != 0)); then
    fails "$1" "waymark-faults ended with code $code; its log is $1/logs/faults.log"
    return 1
  fi
  put_text "$1/recorded" "$wanted"
}

# rows_to_do FOLDER: lines of plan/rows that have no result there.
rows_to_do() {
  local line
  while read -r line; do
    [[ $(cat "$1/${line%% *}/done" 2>/dev/null) == "$line" ]] || echo "$line"
  done <"$plan/rows"
}

# replay FOLDER ROW ESTIMATOR SETTING...
replay() {
  local folder=$1 row=$2 estimator=$3 setting options=() code=0
  local line="${*:2}"
  shift 3
  for setting in "$@"; do options+=(--set "$setting"); done
  rm -rf -- "${folder:?}/$row"
  mkdir -p "$folder/$row"
  "$deploy_dir/replay.sh" "$folder/run.lcm" --estimator "$estimator" --row "$row" "${options[@]}" \
    >"$folder/logs/$row.replay.log" 2>&1 || code=$?
  rm -f -- "$folder/$row/slam.lcm"
  leave_if_told $code
  if ((code == 0)); then
    put_text "$folder/$row/done" "$line"
  else
    fails "$folder/$row" "replay ended with code $code; logs are $folder/logs/$row.*"
  fi
}

# evaluate FOLDER: every row at once.
evaluate() {
  local code=0
  "$bin_dir/waymark-evaluate" run "$1" >"$1/logs/evaluate.log" 2>&1 || code=$?
  leave_if_told $code
  ((code < 2)) || fails "$1" "waymark-evaluate ended with code $code; its log is $1/logs/evaluate.log"
}

# do_folder FOLDER: all estimators on its log.
do_folder() {
  local words
  rm -f -- "$1/failed"
  while read -r -a words; do
    check_disk
    replay "$1" "${words[@]}" </dev/null
  done < <(rows_to_do "$1")
  evaluate "$1"
}

do_job() {
  local variant folder
  check_disk
  record || return 0
  do_folder "$base"
  while read -r variant; do
    folder=$sweep/$scenario+$variant/seed-$seed
    inject "$folder" "$variant" </dev/null || continue
    do_folder "$folder"
    rm -f -- "$folder/run.lcm"  # quickly made again
  done <"$plan/variants"
}

# everything: what the job's result depends on.
everything() { stamp "$plan/scenarios/$scenario.toml" "$plan/images" "$plan/rows" "$plan"/variants*; }

count_finished() {
  local name number
  while read -r name number; do
    [[ ! -e $sweep/$name/seed-$number/finished ]] || echo
  done <"$plan/jobs" | wc -l
}

# report_count: the time left is that of the jobs done since the sweep's start, for those to come.
report_count() {
  local all finished start_s finished_then left=''
  all=$(wc -l <"$plan/jobs") finished=$(count_finished)
  if [[ -f $plan/start ]] && read -r start_s finished_then <"$plan/start" && ((finished > finished_then)); then
    left=", $(((EPOCHSECONDS - start_s) * (all - finished) / (finished - finished_then) / 60)) min left"
  fi
  say "$finished of $all jobs done$left; $scenario seed $seed took $SECONDS s"
}

# done_by_somebody_else: good enough, unless it was to be done again.
done_by_somebody_else() {
  [[ -z $again ]] || die $kExitUsage "$scenario seed $seed is being done by somebody else; wait for that, then do it again"
  say "$scenario seed $seed is being done by somebody else"
  exit 0
}

parse_arguments "$@"
mkdir -p "$sweep/$scenario"
exec {job_lock}>>"$sweep/$scenario/.seed-$seed.lock"
flock --nonblock "$job_lock" || done_by_somebody_else
if [[ -n $again ]]; then rm -rf -- "$base" "$sweep/$scenario+"*"/seed-$seed"; fi
if [[ $(cat "$base/finished" 2>/dev/null) == "$(everything)" ]] && [[ ! -e $base/failed ]]; then exit 0; fi
do_job
put_text "$base/finished" "$(everything)"
[[ -z $count ]] || report_count
if [[ -n $again ]]; then "$bin_dir/waymark-evaluate" sweep "$sweep" --tolerant; fi
