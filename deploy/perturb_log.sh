#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Makes a CARMEN log worse in a named way, to judge an estimator by the worst of many logs and not by one.
#
# usage: deploy/perturb_log.sh LOG OUT.clf [options]
#   LOG             CARMEN text with FLASER lines; .gz or .bz2, too
#   --seed N        of everything that is drawn (default: 1)
#   --bursts        in 30 scans, in three bursts of 10, odometry is off by up to 1 m or 1 rad each
#   --still         odometry stays where it began
#   --odometry-noise S  each step of odometry is off by normal noise: S m and S rad after 1 m, growing
#                   with the root; a radian of turning counts as 0.2 m
#   --odometry-step S   odometry as of coarse encoders: rounded to S m and S rad
#   --noise-m S     normal noise on the ranges
#   --people        three people go along, 0.9 to 1.5 m away: each hides a tenth of the beams
#   --every-s T     scans that are nearer in time to the one before are left out
#   --beam-step N   only each N-th beam
#   --mirror        left is right
#   --reverse       the last scan comes first, and the robot drives backwards
#   --relations FILE  ground truth of LOG, written to OUT.relations as it is of the perturbed log
#
# Replaces OUT.clf and OUT.relations; refuses where one of them is LOG or FILE.
# PARAM lines and the scans' own odometry are kept, ODOM lines are left out: the importer does not read both.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

parse_arguments() {
  seed=1 bursts=0 still=0 odometry_noise=0 odometry_step=0 noise_m=0 people=0 every_s=0 beam_step=1 mirror=0 reverse=0 relations='' files=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --bursts) bursts=1 && shift && continue ;;
      --still) still=1 && shift && continue ;;
      --people) people=1 && shift && continue ;;
      --mirror) mirror=1 && shift && continue ;;
      --reverse) reverse=1 && shift && continue ;;
      --seed | --odometry-noise | --odometry-step | --noise-m | --every-s | --beam-step | --relations) need_value "$@" ;;&
      --seed) need_number "$1" "$2" && seed=$2 ;;
      --odometry-noise) need_decimal "$1" "$2" && odometry_noise=$2 ;;
      --odometry-step) need_decimal "$1" "$2" && odometry_step=$2 ;;
      --noise-m) need_decimal "$1" "$2" && noise_m=$2 ;;
      --every-s) need_decimal "$1" "$2" && every_s=$2 ;;
      --beam-step) need_count "$1" "$2" && beam_step=$2 ;;
      --relations) relations=$2 ;;
      -*) usage_error "unknown option '$1'" ;;
      *) files+=("$1") && shift && continue ;;
    esac
    shift 2
  done
  ((${#files[@]} == 2)) || usage_error "needs LOG and OUT.clf"
  [[ -f ${files[0]} ]] || usage_error "no log '${files[0]}'"
  [[ ${files[1]} == *.clf ]] || usage_error "the result is plain text: OUT.clf, not '${files[1]}'"
  [[ -z $relations || -f $relations ]] || usage_error "no relations '$relations'"
  log=${files[0]} written=${files[1]} written_relations=${files[1]%.clf}.relations
}

# protect_log: what is read is not written at the same time.
protect_log() {
  local input
  for input in "$log" "$relations"; do
    [[ ! $written -ef $input ]] || usage_error "'$written' would replace '$input', which is read; give another OUT.clf"
    [[ -z $relations || ! $written_relations -ef $input ]] ||
      usage_error "'$written_relations' would replace '$input', which is read; give another OUT.clf"
  done
}

unpacked() {
  case $1 in
    *.gz) gzip -dc "$1" ;;
    *.bz2) bzip2 -dc "$1" ;;
    *) cat "$1" ;;
  esac
}

# Time runs backwards about this moment, which keeps times positive.
last_time() { unpacked "$1" | awk '$1 == "FLASER" { last = $(NF - 2) } END { printf "%.6f", last }'; }

perturbed() {
  awk -v seed="$seed" -v bursts="$bursts" -v still="$still" -v people="$people" \
    -v odometry_noise="$odometry_noise" -v odometry_step="$odometry_step" \
    -v noise_m="$noise_m" -v every_s="$every_s" -v beam_step="$beam_step" \
    -v mirror="$mirror" -v reverse="$reverse" -v last_s="$1" '
    function normal() { return sqrt(-2 * log(1 - rand())) * cos(6.283185307179586 * rand()) }
    # Worse odometry, odom_*, follows the increments of the one that was measured.
    function follow(x, y, theta, is_burst,    dx, dy, ahead, left, turn, root) {
      if (scans > 1) {
        dx = x - last_x; dy = y - last_y
        ahead = cos(last_theta) * dx + sin(last_theta) * dy
        left = -sin(last_theta) * dx + cos(last_theta) * dy
        turn = theta - last_theta
        if (is_burst && rand() < 0.5) turn += 2 * rand() - 1
        else if (is_burst) ahead += 2 * rand() - 1
        if (odometry_noise > 0) {
          root = odometry_noise * sqrt(sqrt(ahead * ahead + left * left) + 0.2 * sqrt(wrapped(turn) ^ 2))
          ahead += root * normal()
          turn += root * normal()
        }
        odom_x += cos(odom_theta) * ahead - sin(odom_theta) * left
        odom_y += sin(odom_theta) * ahead + cos(odom_theta) * left
        odom_theta += turn
      } else { odom_x = x; odom_y = y; odom_theta = theta }
      if (still) { odom_x = 0; odom_y = 0; odom_theta = 0 }
      last_x = x; last_y = y; last_theta = theta
    }
    # A range of the beam at that share of the scan: the people walk about the robot.
    function nearest(range, share,    person, off, away) {
      for (person = 1; person <= 3; ++person) {
        off = share - 0.5 - 0.45 * sin(0.15 * person * (time - first_s) + person)
        away = 1.2 + 0.3 * sin(0.4 * (time - first_s) + person)
        if (off * off < 0.0025 && (range <= 0 || range > away)) range = sprintf("%.3f", away + 0.01 * normal())
      }
      return range
    }
    function rounded(value) { return odometry_step > 0 ? odometry_step * int(value / odometry_step + (value < 0 ? -0.5 : 0.5)) : value }
    function wrapped(angle) { return atan2(sin(angle), cos(angle)) }
    function written(line,    word, n, count, kept, i, beam, range, text, sign, is_burst) {
      n = split(line, word, " ")
      count = word[2]
      time = word[n - 2]
      if (reverse) time = 2 * last_s - time
      if (scans > 0 && time < last_written_s + every_s) return
      ++scans; last_written_s = time
      text = ""; kept = 0
      for (i = 0; i < count; i += beam_step) {
        beam = mirror ? count - 1 - i : i
        range = word[3 + beam]
        if (people) range = nearest(range, i / count)
        if (noise_m > 0 && range > 0 && range < 50) range = sprintf("%.3f", range + noise_m * normal())
        text = text " " (range < 0 ? 0 : range)
        ++kept
      }
      sign = mirror ? -1 : 1
      is_burst = bursts && scans % int(all / every / 4) < 10 && scans >= all / every / 4 && scans < all / every * 0.9
      follow(word[count + 6], sign * word[count + 7], sign * word[count + 8], is_burst)
      # The LiDAR pose of the line shows its mounting: as far from the odometry as it was.
      dx = word[count + 3] - word[count + 6]; dy = word[count + 4] - word[count + 7]
      ahead = cos(word[count + 8]) * dx + sin(word[count + 8]) * dy
      left = sign * (-sin(word[count + 8]) * dx + cos(word[count + 8]) * dy)
      turn = sign * (word[count + 5] - word[count + 8])
      said_x = rounded(odom_x); said_y = rounded(odom_y); said_theta = rounded(odom_theta)
      printf "FLASER %d%s %.6f %.6f %.6f %.6f %.6f %.6f %.6f nohost %.6f\n", kept, text, \
        said_x + cos(said_theta) * ahead - sin(said_theta) * left, said_y + sin(said_theta) * ahead + cos(said_theta) * left, \
        wrapped(said_theta + turn), said_x, said_y, wrapped(said_theta), time, time
    }
    BEGIN { srand(seed) }
    $1 == "PARAM" { print }
    $1 == "FLASER" { lines[++all] = $0; if (all == 1) first_s = $(NF - 2); end_s = $(NF - 2) }
    END {
      every = every_s > 0 ? all * every_s / (end_s - first_s) : 1  # scans for each that stays
      if (every < 1) every = 1
      for (i = 1; i <= all; ++i) written(lines[reverse ? all + 1 - i : i])
    }'
}

# x y yaw of the relation as seen by the perturbed log.
perturbed_relations() {
  awk -v mirror="$mirror" -v reverse="$reverse" -v last_s="$1" '
    NF >= 8 {
      from = $1; to = $2; x = $3; y = $4; yaw = $8
      if (mirror) { y = -y; yaw = -yaw }
      if (reverse) {
        from = 2 * last_s - $2; to = 2 * last_s - $1
        back_x = -cos(yaw) * x - sin(yaw) * y; back_y = sin(yaw) * x - cos(yaw) * y
        x = back_x; y = back_y; yaw = -yaw
      }
      printf "%.6f %.6f %.6f %.6f 0 0 0 %.6f\n", from, to, x, y, yaw
    }' "$2"
}

parse_arguments "$@"
protect_log
last_s=$(last_time "$log")
[[ $last_s != 0.000000 && -n $last_s ]] || usage_error "no FLASER lines in '$log'"
make_folder "$(dirname "$written")" >/dev/null
trap 'rm -f -- "$written.part" "$written_relations.part"' EXIT
unpacked "$log" | perturbed "$last_s" >"$written.part"
[[ -z $relations ]] || perturbed_relations "$last_s" "$relations" >"$written_relations.part"
mv -- "$written.part" "$written"
[[ -z $relations ]] || mv -- "$written_relations.part" "$written_relations"
