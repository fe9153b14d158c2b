#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Real logs through estimators, and one table: error, processor time, memory.
#
# usage: deploy/real_logs.sh --out DIR [options] [FOLDER...]
#   FOLDER            holds logs: NAME.clf or NAME.log (CARMEN; .gz or .bz2, too) and NAME.lcm (LCM), and what is
#                     known of them, NAME.relations (default: $WAYMARK_DATA/logs, else ../shared/data/logs)
#   --estimators LIST rows, NAME or NAME=ESTIMATOR:KEY=VALUE:..., separated by commas (default: gmapping,waymark)
#   --seeds LIST      of slam, e.g. 1-3 or 1,5 (default: 1)
#   --set KEY=VALUE   of every row; may be given several times
#   --logs LIST       only these names, separated by commas
#   --import NAME:OPTIONS  more options of waymark-import for a log; may be given several times. An LCM log that has
#                     none is taken for a MAEBot's: --encoder-channel MAEBOT_ENCODERS --reference-channel SLAM_POSE
#   --out DIR         results, and each log as it was imported: imported anew only when log, options or importer change
#   --jobs N          runs at the same time (default: 1, so that they do not disturb each other's times)
#
# NAME_ANYTHING without relations of its own takes those of NAME. Results: DIR/results.md, results.csv, and per run
# DIR/NAME/ROW-sSEED as from deploy/replay.sh. Exit code 1 when a run failed: `failed` in its row of the table.
# Deletes, in DIR, an imported log that is out of date, and the results of an earlier run of the same row; the logs in
# FOLDER are only read.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"
# shellcheck source=deploy/lists.sh
source "$deploy_dir/lists.sh"

parse_arguments() {
  out='' estimators=gmapping,waymark seeds=1 jobs=1 wanted='' folders=() settings=()
  declare -gA import_options=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --out | --estimators | --seeds | --set | --logs | --import | --jobs) need_value "$@" ;;&
      --out) out=$2 ;;
      --estimators) estimators=$2 ;;
      --seeds) seeds=$2 ;;
      --set) settings+=("$2") ;;
      --logs) wanted=$2 ;;
      --import)
        [[ $2 == ?*:?* ]] || usage_error "--import needs NAME:OPTIONS, not '$2'"
        import_options[${2%%:*}]=${2#*:}
        ;;
      --jobs) need_count "$1" "$2" && jobs=$2 ;;
      -*) usage_error "unknown option '$1'" ;;
      *) folders+=("$1") && shift && continue ;;
    esac
    shift 2
  done
  [[ -n $out ]] || usage_error "--out is missing"
  ((${#folders[@]} > 0)) || folders=("${WAYMARK_DATA:-$deploy_dir/../../shared/data}/logs")
  expand_seeds
  expand_rows
}

# name_of FILE: without folder and what says the format.
name_of() {
  local name=${1##*/}
  name=${name%.gz} name=${name%.bz2}
  echo "${name%.*}"
}

# find_logs: sets names, and file_of, relations_of by name.
find_logs() {
  local folder file name
  declare -gA file_of=() relations_of=()
  names=()
  for folder in "${folders[@]}"; do
    [[ -d $folder ]] || die $kExitUsage "no folder '$folder' with logs; name one"
    for file in "$folder"/*.clf "$folder"/*.log "$folder"/*.{clf,log}.{gz,bz2} "$folder"/*.lcm; do
      [[ -f $file ]] || continue
      name=$(name_of "$file")
      is_wanted "$name" || continue
      need_row_name "$name"
      [[ ! -v file_of[$name] ]] || die $kExitUsage "two logs are called '$name': ${file_of[$name]} and $file"
      names+=("$name") file_of[$name]=$(realpath "$file") relations_of[$name]=''
      if [[ -f $folder/$name.relations ]]; then
        relations_of[$name]=$(realpath "$folder/$name.relations")
      elif [[ -f $folder/${name%%_*}.relations ]]; then
        relations_of[$name]=$(realpath "$folder/${name%%_*}.relations")
      fi
    done
  done
  ((${#names[@]} > 0)) || die $kExitUsage "no log${wanted:+ called $wanted} in ${folders[*]}"
}

is_wanted() { [[ -z $wanted || ,$wanted, == *",$1,"* ]]; }

# import_log NAME: DIR/NAME/run.lcm with robot.toml beside it, as the importer of today makes it.
import_log() {
  local name=$1 file=${file_of[$1]} folder=$out/$1 kind=carmen key options
  options=${import_options[$name]:-}
  if [[ $file == *.lcm ]]; then
    kind=mbot
    options=${options:-"--encoder-channel MAEBOT_ENCODERS --reference-channel SLAM_POSE"}
  fi
  key=$(sha256sum "$file" "$bin_dir/waymark-import" && echo "$kind $options")
  mkdir -p "$folder"
  [[ ! -f $folder/import.key || $(<"$folder/import.key") != "$key" ]] || return 0
  rm -f "$folder"/{import.key,run.lcm,robot.toml,reference.tum}
  # shellcheck disable=SC2086  # several options
  "$bin_dir/waymark-import" $kind "$file" --out "$folder/run.lcm" --tolerant $options >"$folder/import.txt" 2>&1 ||
    die $? "import of $file failed: $(tail -1 "$folder/import.txt")"
  printf '%s\n' "$key" >"$folder/import.key"
}

# run_row NAME SEED ROW ESTIMATOR [KEY=VALUE...]: one run, evaluated if replay.sh's exit code, in logs/ROW.code, is 0;
# what went wrong is in its own log. An earlier run's logs go first, for a replay that is refused leaves them.
run_row() {
  local name=$1 seed=$2 row=$3-s$2 estimator=$4 setting options=() folder logs=$out/$1/logs code=0
  shift 4
  folder=$out/$name/$row
  [[ $estimator != gmapping ]] || options+=(--config "$deploy_dir/gmapping/slam_gmapping.toml")
  for setting in slam.map_period_s=3600 "slam.seed=$seed" "${settings[@]}" "$@"; do options+=(--set "$setting"); done
  rm -f -- "$logs/$row".* "$folder"/{online,final,walls}.txt
  "$deploy_dir/replay.sh" "$out/$name/run.lcm" --estimator "$estimator" --row "$row" "${options[@]}" \
    >"$logs/$row.txt" 2>&1 || code=$?
  put_text "$logs/$row.code" $code
  ((code == 0)) || return 0
  evaluate "$folder/trajectory.tum" >"$folder/online.txt" || true
  local final=$folder/trajectory_final.tum
  [[ -f $final ]] || final=$folder/trajectory.tum
  evaluate "$final" >"$folder/final.txt" || true
  "$bin_dir/waymark-evaluate" run "$out/$name" --estimators "$row" >/dev/null 2>&1 || true
  sed -nE 's/^ *"wall_cells": ([0-9]+),?$/wall_cells: \1/p' "$folder/metrics.json" >"$folder/walls.txt" || true
}

# evaluate TRAJECTORY: of run_row's log, lines of `key: value`.
evaluate() {
  if [[ -n ${relations_of[$name]} ]]; then
    "$bin_dir/waymark-evaluate" relations "$1" "${relations_of[$name]}" --tolerant 2>/dev/null
  elif [[ -f $out/$name/reference.tum ]]; then
    "$bin_dir/waymark-evaluate" trajectory "$1" "$out/$name/reference.tum" --align se2 --tolerant 2>/dev/null
  fi
}

readonly kColumns=log,row,seed,measure,translation_m,near_m,far_m,rotation_deg,online_translation_m,online_near_m,online_far_m,online_rotation_deg,wall_cells,scans,updates,ms_per_scan,ms_per_update,worst_ms,processor_s,peak_mb

# collect NAME ROW SEED: one line of results.csv; what is not known is empty.
collect() {
  local folder=$out/$1/$2-s$3 files=() file
  for file in "$folder"/{final,online,walls}.txt "$out/$1/logs/$2-s$3".{slam.log,code}; do
    [[ ! -f $file ]] || files+=("$file")
  done
  awk -v start="$1,$2,$3" '
    function rounded(value, decimals) { return value == "" ? "" : sprintf("%.*f", decimals, value) }
    FILENAME ~ /final.txt$/ { final[$1] = $2 }
    FILENAME ~ /online.txt$/ { online[$1] = $2 }
    FILENAME ~ /walls.txt$/ { walls = $2 }
    FILENAME ~ /.code$/ { is_done = $1 == 0 }
    match($0, /estimator: [0-9]+ observations.*/) {
      split(substr($0, RSTART), word, " ")
      scans = word[2]; updates = word[4]; busy_s = word[6]; worst_ms = word[12]; process_s = word[15]
    }
    match($0, /peak memory [0-9]+ MB/) { split(substr($0, RSTART), word, " "); peak_mb = word[3] }
    function error_of(values) {
      if (measure == "relations")
        return rounded(values["translation_mean_m:"], 4) "," rounded(values["near_translation_mean_m:"], 4) "," \
          rounded(values["far_translation_mean_m:"], 4) "," rounded(values["rotation_mean_deg:"], 3)
      return rounded(values["ate_se2_m:"], 4) ",,," rounded(values["heading_rms_deg:"], 3)
    }
    END {
      measure = !is_done ? "failed" : "translation_mean_m:" in final ? "relations" : "ate_se2_m:" in final ? "ate" : "none"
      print start "," measure "," error_of(final) "," error_of(online) "," walls "," scans "," updates "," \
        (scans > 0 ? rounded(1e3 * busy_s / scans, 2) : "") "," (updates > 0 ? rounded(1e3 * busy_s / updates, 2) : "") "," \
        worst_ms "," rounded(process_s, 1) "," peak_mb
    }' /dev/null "${files[@]}"
}

# table: results.csv for people.
table() {
  awk -F, '
    NR == 1 {
      print "| log | row | seed | error m | near m | far m | rotation ° | on line: error m | near m | far m | rotation ° | walls cells | updates of scans | ms per scan | ms per update | worst ms | processor s | MB |"
      print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
      next
    }
    {
      line = "| " $1 " | " $2 " | " $3 " | " ($4 == "failed" ? "failed" : $5 ($4 == "ate" ? " (ATE)" : ""))
      for (i = 6; i <= 13; ++i) line = line " | " $i
      print line " | " $15 " of " $14 " | " $16 " | " $17 " | " $18 " | " $19 " | " $20 " |"
    }' "$out/results.csv"
}

parse_arguments "$@"
need_programs waymark-{import,slam,viewer,evaluate}
check_rows "${settings[@]}"
find_logs
out=$(make_folder "$out")
for name in "${names[@]}"; do
  import_log "$name"
  mkdir -p "$out/$name/logs"
done
for seed in "${seed_list[@]}"; do
  for row in "${rows[@]}"; do
    for name in "${names[@]}"; do
      while (($(jobs -rp | wc -l) >= jobs)); do wait -n; done
      read -ra words <<<"$row"
      say "$name ${words[0]} seed $seed" >&2
      run_row "$name" "$seed" "${words[@]}" </dev/null &
    done
  done
done
wait
{
  echo "$kColumns"
  for name in "${names[@]}"; do
    for row in "${rows[@]}"; do
      for seed in "${seed_list[@]}"; do collect "$name" "${row%% *}" "$seed"; done
    done
  done
} >"$out/results.csv"
table | tee "$out/results.md"
! grep -q ',failed,' "$out/results.csv" || die $kExitFailed "runs have failed: see DIR/NAME/logs"
