#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Stands in for waymark-sim, -slam, ... in scripts_test.sh: does what the environment says.
#   FAKE_DIR              shared folder: pids of all that ran; the file `closed` says that the run is over
#   FAKE_sim_seconds      length of the run (default 0.5)
#   FAKE_sim_waits_for=N  it ends only when so many programs, itself included, are there
#   FAKE_NAME_exit=CODE   NAME ends at once with this code; `crash` kills itself
#   FAKE_NAME_fails=WORDS NAME ends with code 1, as a replay, too, when its arguments have these words
#   FAKE_NAME_kills=WORDS the same, and NAME kills whoever called it
#   FAKE_NAME_refuses=WORDS NAME --check ends with code 2 when its arguments have these words
#   FAKE_NAME_thinks=S    NAME --check takes so many seconds
#   FAKE_NAME_replays=S   a replay takes so many seconds
#   FAKE_NAME_replayed=CODE a replay comes to its end with this code
#   FAKE_channels=NAMES   a log has these channels (default: LIDAR MARKERS ODOMETRY)
#   FAKE_viewer_mute=1    a replay leaves no map
#   FAKE_NAME_stays=1     NAME ignores both the end of the run and SIGINT
# With --real-time all but the simulator run until SIGINT and then end well.
name=${0##*/waymark-}
setting() {
  local variable=FAKE_${name}_$1
  echo "${!variable:-}"
}

# argument NAME ARGUMENTS...: the word after NAME.
argument() {
  local wanted=$1
  shift
  while (($# > 1)); do
    [[ $1 != "$wanted" ]] || echo "$2"
    shift
  done
}

if [[ -n $(setting fails) && " $* " == *"$(setting fails)"* ]]; then
  echo "$name fails" >&2
  exit 1
fi
if [[ -n $(setting kills) && " $* " == *"$(setting kills)"* ]]; then
  kill -KILL $PPID
  exit 1
fi
case " $* " in
  *" --check "*)
    [[ -z $(setting refuses) || " $* " != *"$(setting refuses)"* ]] || { echo "$name refuses" >&2 && exit 2; }
    [[ -z $(setting thinks) ]] || { echo $$ >>"$FAKE_DIR/pids" && sleep "$(setting thinks)"; }
    exit ;;
  *" --print-channels "*) tr ' ' '\n' <<<"${FAKE_channels:-LIDAR MARKERS ODOMETRY}" && exit ;;
  *" --list "*) echo wrong_ids && exit ;;
  *" --variant "*) touch "$(argument --out "$@")"/{run.lcm,robot.toml} && exit ;;
  " run "* | " sweep "*) echo "$*" >>"$FAKE_DIR/$name.calls" && exit ;;
  *" --print-config run.seed "*)
    seed=$(sed -nE 's/^seed = ([0-9]+).*/\1/p' "$(argument --config "$@")")
    echo "${seed:-7}"
    exit ;;
  *" --print-config robot.markers.survey_file "*) sed -nE 's/.*robot.markers.survey_file=([^ ]+).*/\1/p' <<<"$*" && exit ;;
  *" --print-config slam.estimator "*)
    sed -E 's/.*slam.estimator=([a-z_]+).*/\1/' <<<"slam.estimator=fake_estimator $*"
    exit ;;
  *" --dump-config "*)
    estimator=$(sed -E 's/.*slam.estimator=([a-z_]+).*/\1/' <<<"slam.estimator=fake_estimator $*")
    if [[ $estimator == unknown ]]; then
      echo "slam.estimator: got 'unknown', expected one of those there are" >&2
      exit 2
    fi
    printf '[run]\nseed = 7  # seed\n\n[slam]\nestimator = "%s"  # name\n' "$estimator"
    exit ;;
  *" --dump-robot-config "*) echo "[robot]" && exit ;;
  " carmen "*) log=$(argument --out "$@") && touch "$log" "${log%/*}/robot.toml" && exit ;;
  " relations "*) echo "translation_mean_m: 0.5" && exit ;;
  *" --log "*) # replay
    [[ -z $(setting replays) ]] || { echo $$ >>"$FAKE_DIR/pids" && exec sleep "$(setting replays)"; }
    echo "estimator: 9 observations, 9 updates, 1.0 s of processor time, worst 2.0 ms" >&2
    echo '{"messages": 12, "wall_s": 0.5}' >"$(argument --report "$@")"
    echo "$*" >"$FAKE_DIR/$name.replay"
    [[ $name != slam && $name != detector ]] || touch "$(argument --out-log "$@")"
    [[ $name != viewer || -n $(setting mute) ]] || touch "$(argument --out "$@")"/{map.pgm,trajectory.tum}
    code=$(setting replayed)
    exit "${code:-0}" ;;
esac

real_time=
[[ " $* " != *" --real-time "* || $name == sim ]] || real_time=1
on_signal() {
  echo "$name" >>"$FAKE_DIR/interrupted"
  [[ -n $real_time ]] || exit 130
  exit 0
}
# Read before the traps: bash may lose a signal that comes while it reads a $(...).
stays=$(setting stays)
fate=$(setting exit)
end=$((${EPOCHREALTIME/./} + $(awk "BEGIN { print int(1e6 * ${FAKE_sim_seconds:-0.5}) }")))
if [[ -n $stays ]]; then trap '' INT TERM; else trap on_signal INT TERM; fi
echo "$*" >"$FAKE_DIR/$name.arguments"
echo "$name says something" >&2
echo $$ >>"$FAKE_DIR/pids.$name"
echo $$ >>"$FAKE_DIR/pids"  # last: whoever waits for it finds the rest
case $fate in
  '') ;;
  crash) kill -SEGV $$ ;;
  *) exit "$fate" ;;
esac
while [[ -n $real_time$stays || ! -e $FAKE_DIR/closed ]]; do
  mapfile -t programs <"$FAKE_DIR/pids"
  if [[ $name == sim ]] && ((${EPOCHREALTIME/./} > end && ${#programs[@]} >= ${FAKE_sim_waits_for:-0})); then
    touch "$FAKE_DIR/closed"
    break
  fi
  sleep 0.02
done
[[ $name != recorder ]] || touch "$(argument --out-log "$@")"
