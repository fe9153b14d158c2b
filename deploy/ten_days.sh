#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Ten days in one building: a short corridor is mapped, and each day's run extends the map of the day before, while things
# change. Every other day the robot drives the other way; doors and boxes come and go, one marker a day is covered, one is
# hung elsewhere for good on the fourth day, and one is taken down for good on the seventh.
#
# usage: deploy/ten_days.sh [options]
#   --out DIR   (default: runs/ten_days)
#   --days N    after the one that draws the map (default: 10)
#   --seed N    of the first day; each later one has the next (default: 1)
#
# Writes DIR/day_NN (runs) and DIR/day_NN.map.lcm, and prints a line for each day: length on the map image, ATE in the
# first map's frame, markers in the map, keyframes, size of the file.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

parse_arguments() {
  out=runs/ten_days days=10 seed=1
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --out | --days | --seed) need_value "$@" ;;&
      --out) out=$2 ;;
      --days) need_count "$1" "$2" && days=$2 ;;
      --seed) need_number "$1" "$2" && seed=$2 ;;
      *) usage_error "unknown option '$1'" ;;
    esac
    shift 2
  done
}

# scenario_of DAY: 14 m of corridor with four pairs of markers, as they are on that day.
scenario_of() {
  local day=$1 covered=() door='' box='' start='start_x_m = 1.0' end_x_m=13.0 start_yaw_rad=0.0 moved=''
  if ((day > 0 && day * 3 % 8 != 5)); then covered=($((day * 3 % 8))); fi  # 5 is the one that moves
  if ((day >= 7)); then covered+=(2); fi
  if ((day >= 4)); then moved='moved = [{ place = 5, at_m = 0.02, dx_m = 0.8 }]'; fi
  if ((day % 3 == 1)); then door='{ side = "left", centre_m = 7.5 }'; fi
  if ((day % 4 >= 2)); then box='{ x_m = 10.5, y_m = -0.75, length_m = 0.8, width_m = 0.35, height_m = 1.2 }'; fi
  if ((day % 2 == 1)); then start='start_x_m = 13.0' end_x_m=1.0 start_yaw_rad=3.14159265; fi
  cat <<END
[world]
length_m = 14.0
openings = [$door]
boxes = [$box]
[markers]
first_m = 3.0
spacing_m = 3.0
last_m = 12.0
missing = [$(IFS=, && echo "${covered[*]}")]
$moved
[route]
$start
start_yaw_rad = $start_yaw_rad
waypoints = [{ x_m = $end_x_m }]
speed_mps = 0.25
END
}

# figure KEY FILE: the first number of that name in a JSON file.
figure() { sed -nE "s/.*\"$1\": \"?([-0-9.e]+).*/\1/p" "$2" | head -n 1; }

run_day() {
  local day=$1 name options=()
  name=$(printf 'day_%02d' "$day")
  scenario_of "$day" >"$out/$name.toml"
  ((day == 0)) || options=(--load-map "$map" --mode extend --start anywhere)
  "$deploy_dir/launch.sh" "$out/$name.toml" --seed $((seed + day)) --out "$out/$name" "${options[@]}" \
    --save-map "$out/$name.map.lcm" >"$out/$name.log" 2>&1 || die $? "$name went wrong; its log is $out/$name.log"
  map=$out/$name.map.lcm
  "$bin_dir/waymark-evaluate" run "$out/$name" --mapped-in "$out/day_00" >"$out/$name.table"
  "$bin_dir/waymark-map" info "$map" --json >"$out/$name.json"
  printf '%3d  %8s  %8s  %7s  %9s  %8s\n' "$day" "$(figure length_px "$out/$name/results.json")" \
    "$(figure ate_frame_m "$out/$name/results.json")" "$(figure confirmed_markers "$out/$name.json")" \
    "$(figure keyframes "$out/$name.json")" "$(figure bytes "$out/$name.json")"
}

parse_arguments "$@"
need_programs waymark-evaluate waymark-map
out=$(make_folder "$out")
map=
echo 'day  length px  ATE frame m  markers  keyframes     bytes'
for ((day = 0; day <= days; ++day)); do run_day "$day"; done
