#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The figures and plots of docs/accuracy.md: sweeps of the default corridor, the limit that each log's
# data set, and the growth of the error with the corridor's length.
#
# usage: deploy/accuracy.sh --out DIR [options]
#   --seeds LIST            of the default corridor (default: 1-20)
#   --ablation-seeds LIST   the ones of them that every ablation is replayed on (default: 1-5)
#   --length-seeds N        synthetic drives per length (default: 10; 0 = leave them out)
#   --images DIR            where the plots go (default: DIR/plots of --out)
#   --out DIR               the same command again goes on where it stopped; logs that are there are used
#   --jobs N                jobs at the same time (default: one per core)
#
# Results in DIR: corridor.md and corridor_runs.csv (every seed), consistency.txt, ablations.csv,
# limit.csv (per seed the limit with all of the log and with what came before each pose, and waymark's
# error), length.dat, summary.txt.
# Replaces these files; in DIR/sweep it deletes what deploy/sweep.sh does (see its --help).
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

# NAME=ESTIMATOR:KEY=VALUE:... as in deploy/sweep.sh.
readonly kFixedOdometry='slam.waymark.odometry.scale_sigma=1e-6:slam.waymark.odometry.turn_scale_sigma=1e-6:slam.waymark.odometry.drift_sigma_rad_per_m=1e-6:slam.waymark.odometry.lidar_ahead_sigma_m=1e-6:slam.waymark.odometry.lidar_yaw_sigma_rad=1e-6'
readonly kFixedCamera='robot.camera.yaw_sigma_rad=0:robot.camera.focal_sigma=0'
ablations=(
  odometry
  waymark
  the_paper=marker_matching
  no_loops=waymark:slam.waymark.loops.enabled=false
  noise_not_learnt=waymark:slam.waymark.learn_noise=false
  window_10=waymark:slam.waymark.window_keyframes=10
  window_all=waymark:slam.waymark.window_keyframes=100000
  "odometry_not_learnt=waymark:$kFixedOdometry"
  "camera_not_learnt=waymark:$kFixedCamera"
  no_ids=waymark:slam.blank_ids=true
)

parse_arguments() {
  out='' images='' seeds=1-20 ablation_seeds=1-5 length_seeds=10 jobs=$(nproc)
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --out | --images | --seeds | --ablation-seeds | --length-seeds | --jobs) need_value "$@" ;;&
      --out) out=$2 ;;
      --images) images=$2 ;;
      --seeds) seeds=$2 ;;
      --ablation-seeds) ablation_seeds=$2 ;;
      --length-seeds) need_number "$1" "$2" && length_seeds=$2 ;;
      --jobs) need_count "$1" "$2" && jobs=$2 ;;
      *) usage_error "unknown argument '$1'" ;;
    esac
    shift 2
  done
  [[ -n $out ]] || usage_error "--out is missing"
}

# sweep SEEDS ROW...
sweep() {
  local swept=$1 rows
  shift
  rows=$(IFS=, && echo "$*")
  "$deploy_dir/sweep.sh" "$deploy_dir/scenarios/corridor.toml" --seeds "$swept" --estimators "$rows" \
    --jobs "$jobs" --out "$out/sweep" >"$out/sweep.log" 2>&1 || die $? "the sweep failed; see $out/sweep.log"
}

# columns_of NAME...: of the sweep's runs.csv, between spaces.
columns_of() {
  awk -F, -v names="$*" '
    BEGIN { n = split(names, wanted, " ") }
    NR == 1 { for (i = 1; i <= NF; ++i) place[$i] = i; next }
    { for (i = 1; i <= n; ++i) printf "%s%s", $place[wanted[i]], i < n ? " " : "\n" }' "$out/sweep/runs.csv"
}

measure_corridor() {
  sweep "$seeds" waymark
  cp "$out/sweep/results.md" "$out/corridor.md"
  cp "$out/sweep/runs.csv" "$out/corridor_runs.csv"
  cp "$out/sweep/plots/stations.dat" "$out/stations.dat"
  mapfile -t folders < <(columns_of folder estimator failed | awk '$2 == "waymark" && $3 == 0 { print $1 }')
  ((${#folders[@]} > 0)) || die $kExitFailed "no seed has a result; see $out/corridor.md"
  "$bin_dir/waymark-evaluate" consistency "${folders[@]/#/$out/sweep/}" >"$out/consistency.txt" || true
}

# measure_limit: what each log allows, with all of it and with what came before each pose.
measure_limit() {
  local folder run place=0
  echo "seed limit_m along_m across_m heading_deg markers_m on_line_m on_line_along_m on_line_across_m" \
    "waymark_m waymark_along_m waymark_across_m ratio" >"$out/limit.csv"
  for folder in "${folders[@]}"; do
    run=$out/sweep/$(dirname "$folder")
    say "limit of seed ${run##*-}, log $((++place)) of ${#folders[@]}"
    "$bin_dir/tests/benchmark/batch_limit" "$run" --on-line --estimate "$run/waymark/trajectory.tum" \
      >"$out/limit.txt" || die $kExitFailed "no limit for $run; see $out/limit.txt"
    awk -v seed="${run##*-}" '
      $1 == "limit" { limit = $3 " " $6 " " $9 " " $12 }
      $1 == "markers" { markers = $3 }
      $1 == "on_line" { on_line = $3 " " $6 " " $9 }
      $1 == "estimate" { waymark = $3 " " $6 " " $9 }
      $1 == "ratio" { print seed, limit, markers, on_line, waymark, $2 }' "$out/limit.txt" >>"$out/limit.csv"
  done
}

measure_ablations() {
  sweep "$ablation_seeds" "${ablations[@]}"
  cp "$out/sweep/results.md" "$out/ablations.md"
  columns_of estimator ate_origin_m | awk '
    NF == 2 { if (!($1 in n)) order[++rows] = $1
              ++n[$1]; squares[$1] += $2 ^ 2; if ($2 > worst[$1]) worst[$1] = $2 }
    END { for (i = 1; i <= rows; ++i) { r = order[i]; print r, sqrt(squares[r] / n[r]), worst[r] } }' \
    >"$out/ablations.csv"
}

measure_length() {
  ((length_seeds > 0)) || return 0
  "$bin_dir/tests/benchmark/length_curve" "$length_seeds" exact >"$out/length.dat"
}

# ellipses RUN: x y of the way and the covariance's ellipse, every 4 m, for the plot.
ellipses() {
  awk '
    NR == FNR { split($0, c, ","); key = sprintf("%.3f", c[1]); xx[key] = c[2]; xy[key] = c[3]; yy[key] = c[5]; next }
    { key = sprintf("%.3f", $1) }
    key in xx && ($2 - last) ^ 2 >= 16 {
      last = $2; mean = (xx[key] + yy[key]) / 2
      root = sqrt(((xx[key] - yy[key]) / 2) ^ 2 + xy[key] ^ 2)
      small = mean > root ? mean - root : 0
      print $2, $3, 4 * sqrt(mean + root), 4 * sqrt(small), atan2(2 * xy[key], xx[key] - yy[key]) / 2 * 57.29578
    }' "$1/waymark/covariance.csv" "$1/waymark/trajectory.tum"
}

plot() {
  images=$(make_folder "${images:-$out/plots}")
  ellipses "$out/sweep/$(dirname "${folders[0]}")" >"$out/ellipses.dat"
  : >"$out/along.dat"
  for folder in "${folders[@]}"; do
    tr , ' ' <"$out/sweep/$folder/stations.csv" | tail -n +2 >>"$out/along.dat"
    printf '\n\n' >>"$out/along.dat"
  done
  gnuplot -e "data='$out'; images='$images'; runs=${#folders[@]}" "$deploy_dir/accuracy.gp" >"$out/plots.log" 2>&1 ||
    die $kExitFailed "no plots; see $out/plots.log"
}

summarise() {
  {
    echo "# waymark over ${#folders[@]} seeds: worst (root mean square)"
    awk -F, '
      NR == 1 { for (i = 1; i <= NF; ++i) name[i] = $i; next }
      $2 == "waymark" { for (i = 7; i <= NF; ++i) if ($i != "") { ++n[i]; s[i] += $i ^ 2; a = $i < 0 ? -$i : $i; if (a > w[i]) w[i] = a } }
      END { for (i = 7; i in name; ++i) if (n[i]) printf "%s %.4g (%.4g)\n", name[i], w[i], sqrt(s[i] / n[i]) }' \
      "$out/corridor_runs.csv"
    tail -n 1 "$out/consistency.txt"
    awk '
      function root_mean_square(i) { return sqrt(squares[i] / n) }
      function row(name, i) {
        printf "%s: ATE %.4f m, along %.4f m, across %.4f m (root mean squares)\n",
          name, root_mean_square(i), root_mean_square(i + 1), root_mean_square(i + 2) }
      NR == 1 { next }
      { ++n
        for (i = 2; i <= NF; ++i) squares[i] += $i ^ 2
        if ($13 > worst) worst = $13
        if ($10 / $7 > worst_on_line) worst_on_line = $10 / $7
        if ($7 / $2 > worst_of_on_line) worst_of_on_line = $7 / $2
        above += $13 > 1.5; above_on_line += $10 / $7 > 1.5 }
      END {
        row("limit", 2); row("limit, on line", 7); row("waymark", 10)
        printf "waymark over the limit: %.2f, worst of a seed %.2f, %d of %d above 1.5\n",
          root_mean_square(10) / root_mean_square(2), worst, above, n
        printf "waymark over the limit on line: %.2f, worst of a seed %.2f, %d above 1.5\n",
          root_mean_square(10) / root_mean_square(7), worst_on_line, above_on_line
        printf "limit on line over the limit: %.2f, worst of a seed %.2f\n",
          root_mean_square(7) / root_mean_square(2), worst_of_on_line }' "$out/limit.csv"
    [[ ! -f $out/length.dat ]] || tail -n 1 "$out/length.dat"
  } >"$out/summary.txt"
  cat "$out/summary.txt"
}

parse_arguments "$@"
need_programs waymark-{sim,detector,slam,viewer,recorder,evaluate} tests/benchmark/{batch_limit,length_curve}
command -v gnuplot >/dev/null || die $kExitUsage "gnuplot is missing; install it with $deploy_dir/install-deps.sh --tests"
out=$(make_folder "$out")
measure_corridor
measure_limit
measure_length
measure_ablations
plot
summarise
