#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The real programs under deploy/launch.sh when they cannot start or are told to stop. (Whole runs, killed
# processes and two stacks at once: tests/simulation.)
#
# usage: tests/process/stack_test.sh BUILD_DIR CASE
# shellcheck disable=SC2317  # cases are called by name
set -euo pipefail

build_dir=${1:?usage: stack_test.sh BUILD_DIR CASE}
# shellcheck source=tests/process/installed.sh
source "$(dirname "${BASH_SOURCE[0]}")/installed.sh"
launch=$work/share/waymark/deploy/launch.sh

cat >"$work/short.toml" <<'END'
[world]
length_m = 7.0
[markers]
first_m = 3.0
spacing_m = 2.0
last_m = 5.0
[route]
end_x_m = 5.0
speed_mps = 0.5
END

readonly page="127.0.0.1:$((20000 + $$ % 10000))" token=0123456789abcdef0123  # of the live page
readonly port=$((8700 + $$ % 1000))
readonly url="udpm://239.255.76.67:$port?ttl=0"

fail() {
  echo "FAILED: $*" >&2
  tail -n 20 "$work"/*.output >&2
  exit 1
}

# begin NAME OPTION...: a run in the background into $work/NAME; its pid is $!.
begin() {
  env --default-signal=INT "$launch" "$work/short.toml" --out "$work/$1" "${@:2}" >"$work/$1.output" 2>&1 &
}

# until_under_way NAME: ticks are going round.
until_under_way() {
  local i
  for ((i = 0; i < 600; ++i)); do
    ! grep -qs '%.*simulated' "$work/$1/logs/sim.log" || return 0
    sleep 0.05
  done
  fail "$1 does not start"
}

# expect_code CODE PID
expect_code() {
  local code=0
  wait "$2" || code=$?
  ((code == $1)) || fail "exit code $code instead of $1"
}

expect_nothing_left() {
  local left
  left=$(pgrep -af -- "$work/bin/waymark-" || true)
  [[ -z $left ]] || fail "left over: $left"
}

ctrl_c_leaves_nothing() {
  begin run
  local run=$!
  until_under_way run
  kill -INT $run
  expect_code 130 $run
  expect_nothing_left
}

no_multicast_route() {
  unshare --map-root-user --net true 2>/dev/null || exit 77
  local code=0
  unshare --map-root-user --net "$launch" "$work/short.toml" --out "$work/run" >"$work/run.output" 2>&1 || code=$?
  ((code == 2)) || fail "exit code $code"
  grep -q "ip route add 224.0.0.0/4 dev lo" "$work/run.output" || fail "no advice"
  expect_nothing_left
}

bad_scenario() {
  printf '[world]\nlenght_m = 7.0\n' >"$work/short.toml"
  begin run
  expect_code 2 $!
  grep -q "length_m" "$work/run.output" || fail "the nearest key is not named"
  [[ ! -e $work/run ]] || fail "a folder for nothing"
}

# A signal between the start of a process and launch.sh's note of it: nothing waits for that process for ever.
a_signal_while_it_starts() {
  local i run
  for ((i = 0; i < 8; ++i)); do
    begin "start$i"
    run=$!
    until [[ -e $work/start$i/logs/recorder.log ]]; do sleep 0.001; done
    sleep "0.00$i"
    kill -TERM $run
    expect_code 143 $run
  done
  expect_nothing_left
}

# A second stack in lockstep on the port of the first is refused before anything of it runs; the first one is as ever.
two_stacks_on_one_port() {
  begin alone --lcm-url "$url"
  expect_code 0 $!
  begin first --lcm-url "$url"
  local first=$!
  until_under_way first
  begin second --lcm-url "$url" --seed 5
  expect_code 2 $!
  grep -q "another simulator runs in lockstep on UDP port" "$work/second.output" || fail "the other stack is not named"
  [[ ! -e $work/second ]] || fail "a folder for nothing"
  expect_code 0 $first
  cmp "$work/alone/run.lcm" "$work/first/run.lcm" || fail "the first run has other bytes"
}

every_program_checks_without_running() {
  local name code
  for name in sim detector slam viewer recorder; do
    "$work/bin/waymark-$name" --check --lcm-url memq:// >"$work/check.output" 2>&1 || fail "$name: exit code $?"
    [[ ! -s $work/check.output ]] || fail "$name is not silent"
    code=0
    "$work/bin/waymark-$name" --check --lcm-url nonsense:// >"$work/check.output" 2>&1 || code=$?
    ((code == 2)) || fail "$name: exit code $code"
    grep -q "cannot join the LCM network nonsense://" "$work/check.output" || fail "$name does not say why"
  done
}

# The simulator has a marker 400; the dictionary of the others has not.
an_old_run_stays_when_the_new_one_cannot_start() {
  mkdir -p "$work/run/logs"
  touch "$work/run/"{run.lcm,logs/launch.log}
  begin run --lcm-url nonsense://
  expect_code 2 $!
  grep -q "cannot join the LCM network nonsense://" "$work/run.output" || fail "the network is not named"
  begin run --mode localise
  expect_code 2 $!
  grep -q "slam refuses its settings" "$work/run.output" || fail "the missing map is not named"
  printf '[robot.markers]\nids = [400]\n' >>"$work/short.toml"
  begin run --lcm-url memq://
  expect_code 2 $!
  grep -q "got 400, but DICT_6X6_250 has the ids 0 to 249" "$work/run.output" || fail "the id is not named"
  grep -q "slam error: configuration" "$work/run.output" || fail "the program is not named"
  [[ -e $work/run/run.lcm ]] || fail "the old run is gone"
}

# timeout(1) signals its command, and then its own group: one wish, twice.
a_recording_that_timeout_ends_is_whole() {
  local i code
  for ((i = 0; i < 5; ++i)); do
    code=0
    timeout --preserve-status --signal INT 1 "$work/bin/waymark-recorder" --real-time --lcm-url "$url" \
      --out-log "$work/$i.lcm" >"$work/$i.output" 2>&1 || code=$?
    [[ -e $work/$i.lcm && ! -e $work/$i.lcm.part ]] || fail "recording $i ended with code $code and is cut short"
  done
}

# The last event of the log is cut short.
replay_of_a_damaged_log() {
  local file code=0
  begin run --record-only --no-images
  expect_code 0 $!
  truncate --size=-1 "$work/run/run.lcm"
  "${launch%launch.sh}replay.sh" "$work/run/run.lcm" --estimator odometry >"$work/replay.output" 2>&1 || code=$?
  ((code == 1)) || fail "exit code $code"
  grep -q "run.lcm: .* bytes from offset .* are no events" "$work/replay.output" || fail "the damage is not named"
  grep -q "odometry is in .*, but not everything went well" "$work/replay.output" || fail "the result is not named"
  for file in map.pgm map.yaml trajectory.tum timings.json; do
    [[ -s $work/run/odometry/$file ]] || fail "no $file"
  done
}

# ask CODE TEXT ARGUMENT...: waymark-command ends with that code and says that.
ask() {
  local expected=$1 text=$2 code=0
  shift 2
  "$work/bin/waymark-command" --lcm-url "$url" "$@" >"$work/ask.output" 2>&1 || code=$?
  ((code == expected)) || fail "waymark-command $*: exit code $code instead of $expected"
  grep -q -- "$text" "$work/ask.output" || fail "waymark-command $* does not say '$text'"
}

# post_command STATUS TEXT JSON TOKEN: the live page at $page answers a command with that.
post_command() {
  local answer
  answer=$(
    exec 8<>"/dev/tcp/${page/://}"
    printf 'POST /command HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer %s\r\nContent-Length: %d\r\nConnection: close\r\n\r\n%s' \
      "$4" "${#3}" "$3" >&8
    cat <&8
  )
  [[ $answer == "HTTP/1.1 $1 "*"$2"* ]] || fail "POST $3: not $1 and '$2', but $answer"
}

# A map that is saved on command; the replay of the log saves the same bytes.
commands_while_it_runs() {
  ask 4 "no answer within 2 s" reset
  ask 2 "" fly
  ask 2 "no_such_channel" --channels <(printf '[channels]\nno_such_channel = "A"\n') reset
  ask 2 "" save
  sed -i 's/^speed_mps = .*/speed_mps = 0.1/' "$work/short.toml"
  local options=(--set slam.commands=true --set "slam.state_folder=$work/state")
  begin run --lcm-url "$url" --http "$page" --http-token too-short "${options[@]}"
  expect_code 2 $!
  grep -q "expected 16 to 200 printable characters" "$work/run.output" || fail "a short token is not named"
  begin run --lcm-url "$url" --http "$page" --http-token "$token" "${options[@]}"
  local run=$! arguments
  until_under_way run
  ask 1 "letters, digits" save ../map
  ask 1 "in that mode already" set-mode map
  ask 1 "not finite" set-pose nan 0 0
  post_command 401 "not the token" '{"command": "reset"}' "${token}X"
  post_command 409 "in that mode already" '{"command": "set-mode", "mode": "map"}' "$token"
  post_command 200 "" '{"command": "save", "name": "from_page"}' "$token"
  until "$work/bin/waymark-command" --lcm-url "$url" save day1 >"$work/ask.output" 2>&1; do
    kill -0 $run || fail "the run ended before a map was saved"
  done
  "$work/bin/waymark-map" check "$work/state/day1.map.lcm" >"$work/check.output" 2>&1 || fail "the map is not whole"
  "$work/bin/waymark-map" info "$work/state/day1.map.lcm" >"$work/info.output" 2>&1 || fail "the map cannot be read"
  grep -q "differs from its description by: odometry's distances" "$work/info.output" || fail "no calibration in the map"
  expect_code 0 $run
  cp "$work/state/day1.map.lcm" "$work/live.map.lcm"
  "$work/bin/waymark-map" export "$work/live.map.lcm" --out "$work/exported" >"$work/export.output" 2>&1 || fail "no export"
  [[ -s $work/exported/map.png && -z $(find "$work/exported" -empty) ]] || fail "the export has empty files"
  for arguments in "export --out $work/exported" "transform --out $work/live.map.lcm" \
    "merge $work/live.map.lcm --out $work/live.map.lcm"; do
    # shellcheck disable=SC2086  # words of a command
    "$work/bin/waymark-map" ${arguments%% *} "$work/live.map.lcm" ${arguments#* } >"$work/again.output" 2>&1 && fail "replaced"
    grep -q 'is there already' "$work/again.output" || fail "waymark-map $arguments"
  done
  "${launch%launch.sh}replay.sh" "$work/run/run.lcm" --estimator waymark --row again "${options[@]}" \
    >"$work/replay.output" 2>&1 || fail "replay: exit code $?"
  cmp "$work/live.map.lcm" "$work/state/day1.map.lcm" || fail "the replay saves another map"
  cmp "$work/run/waymark/map.pgm" "$work/run/again/map.pgm" || fail "the replay draws another map"
  expect_nothing_left
}

# A sweep with real programs: figures, an expectation that cannot be reached, and going on.
sweep() {
  command -v parallel >/dev/null || exit 77
  printf '[expect]\nestimator = "odometry"\nate_origin_m = 0.000001\nmax_wall_cells = 9\n' >>"$work/short.toml"
  local again=("${launch%launch.sh}sweep.sh" "$work/short.toml" --seeds 4 --estimators 'odometry,marker_matching'
    --out "$work/swept")
  "${again[@]}" >"$work/sweep.output" 2>&1 || fail "exit code $?"
  grep -q '^| short | odometry | 1 | .* | 0 | 1 | 0 | ate_origin_m 1e-06, max_wall_cells 9 | MISS |$' "$work/swept/results.md" ||
    fail "no row of odometry"
  grep -q '^| short | marker_matching | 1 | .* | 0 | 0 | 0 | - | - |$' "$work/swept/results.md" || fail "no row of marker_matching"
  grep -q '"got": ' "$work/swept/short/seed-4/odometry/metrics.json" || fail "no expectation in metrics.json"
  local line
  line=$(grep -- '--again$' "$work/swept/results.md") || fail "no command for the seed that missed"
  [[ $line == "${launch%launch.sh}sweep_job.sh $work/swept short 4 --again" ]] || fail "the command is $line"
  "${again[@]}" >"$work/sweep.output" 2>&1 || fail "exit code $? the second time"
  ! grep -q "jobs done" "$work/sweep.output" || fail "the job was done twice"
  expect_nothing_left
}

# A program with an MBot's own types reads a live run by an MBot's names, and resets it.
mbot_client() {
  sed -i 's/^length_m.*/length_m = 14.0/; s/^end_x_m.*/end_x_m = 12.0/' "$work/short.toml"
  printf '[run]\nrolling_scan = true\n' >>"$work/short.toml"  # an MBot's lidar_t
  begin run --real-time --channels "$source_dir/deploy/mbot.toml" --lcm-url "$url"
  local run=$! code=0
  "$build_dir/tests/process/mbot_client" "$url" >"$work/client.output" || code=$?
  kill -INT $run
  wait $run || true
  ((code == 0)) || fail "the client is not content: exit code $code"
  grep -q "MBOT_SYSTEM_RESET refused 1" "$work/run/logs/slam.log" || fail "the refusal is not counted"
  expect_nothing_left
}

# Somebody else publishes wrong copies of the sensors' messages, 1,500 a second and stamped up to 30 s ahead.
a_rival_in_real_time() {
  local rival file
  begin run --real-time --lcm-url "$url"
  local run=$!
  until_under_way run
  /usr/bin/python3 -B "$source_dir/tests/support/rival.py" "$port" 300 >"$work/rival.output" 2>&1 &
  rival=$!
  expect_code 0 $run
  kill $rival
  for file in map.pgm trajectory.tum markers.csv; do [[ -s $work/run/waymark/$file ]] || fail "no $file"; done
  grep -q "LIDAR: .* publishes, too, and is refused as long as" "$work/run/logs/slam.log" || fail "the rival is not named"
  grep -q "rejected: .*LIDAR rejected: somebody else publishes, too" "$work/run/logs/slam.log" ||
    fail "the rival's messages are not counted"
  ! grep -q "scans dropped\|late, dropped\|clock was set" "$work/run/logs/slam.log" || fail "it disturbs what is real"
  "$work/bin/waymark-evaluate" run "$work/run" >"$work/evaluate.output" 2>&1 || fail "no figures"
  expect_nothing_left
}

# Each process hangs for a while, one after the other: the run goes on, and every scan is used.
stopped_processes_in_real_time() {
  local name run pid
  begin run --real-time --lcm-url "$url"
  run=$!
  until_under_way run
  for name in detector slam viewer recorder; do
    pid=$(pgrep -f -- "$work/bin/waymark-$name ") || fail "no $name"
    kill -STOP "$pid"
    sleep 0.4
    kill -CONT "$pid"
    sleep 0.2
  done
  expect_code 0 $run
  ! grep -q "scans dropped" "$work/run/logs/slam.log" || fail "scans are lost"
  [[ $("$work/bin/waymark-evaluate" length "$work/run/waymark/map.yaml" --json) =~ \"length_px\":\ *1(39|40|41) ]] || fail "a wrong map"
  expect_nothing_left
}

# The units, with the programs where they are: nothing that systemd does not know, and hardly a privilege.
systemd_units() {
  command -v systemd-analyze >/dev/null || exit 77
  local name
  cp -r "$source_dir/deploy/systemd" "$work/units"
  sed -i "s#waymark-\(detector\|slam\|viewer\|recorder\) --real-time#$work/bin/&#" "$work/units/"*.service
  systemd-analyze verify "$work/units/"*.service "$work/units/waymark.target" >"$work/verify.output" 2>&1 || fail "exit code $?"
  [[ ! -s $work/verify.output ]] || fail "systemd has something to say"
  for name in detector slam viewer recorder; do
    systemd-analyze security --offline=true --threshold=15 "$work/units/waymark-$name.service" >"$work/security.output" 2>&1 ||
      fail "$name is exposed"
  done
}

# Type=notify and WatchdogSec: what a program says to its supervisor.
a_supervisor_is_told() {
  /usr/bin/python3 -c '
import socket, sys
s = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
s.bind(sys.argv[1])
s.settimeout(10)
while True:
    state = s.recv(100).decode()
    print(state, flush=True)
    if state == "STOPPING=1": break' "$work/notify" >"$work/states" &
  local listener=$! i
  for ((i = 0; i < 100; ++i)); do [[ ! -S $work/notify ]] || break; sleep 0.05; done
  NOTIFY_SOCKET=$work/notify env --default-signal=INT "$work/bin/waymark-recorder" --real-time --lcm-url "$url" \
    --out-log "$work/run.lcm" >"$work/recorder.output" 2>&1 &
  local recorder=$!
  for ((i = 0; i < 100; ++i)); do ! grep -qs WATCHDOG "$work/states" || break; sleep 0.05; done
  kill -INT $recorder
  wait $listener || fail "it did not say that it stops"
  expect_code 1 $recorder  # nothing came to be recorded
  [[ $(uniq "$work/states" | xargs) == "READY=1 WATCHDOG=1 STOPPING=1" ]] || fail "it said: $(cat "$work/states")"
}

# A real browser looks at a run whose camera goes off.
live_page() {
  local code=0
  sed -i 's/^length_m.*/length_m = 14.0/; s/^end_x_m.*/end_x_m = 12.0/' "$work/short.toml"
  printf '[[faults]]\nsensor = "camera"\nkind = "off"\nfrom_m = 5.0\n' >>"$work/short.toml"
  command -v chromium >/dev/null && command -v chromedriver >/dev/null || exit 77
  begin run --real-time --http "$page" --http-token "$token" --set slam.commands=true --set "slam.state_folder=$work/state"
  local run=$!
  /usr/bin/python3 -B "$source_dir/tests/browser/live_page_test.py" "http://$page/" "$token" >"$work/page.output" 2>&1 || code=$?
  kill -INT $run
  wait $run || true
  ((code == 0)) || fail "the page: exit code $code"
  expect_nothing_left
}

# never_reads: a client that asks for the stream of views, and takes nothing of it.
never_reads() {
  exec 8<>"/dev/tcp/${page/://}"
  printf 'GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n' >&8
  exec sleep 300 8<&8
}

# The same run without the page, and with two clients of which one never reads.
live_page_changes_no_byte() {
  has_event() { sleep 0.05 && grep -q '^data: {"time_s"' "$work/events"; }
  local file reader deaf
  begin plain
  expect_code 0 $!
  begin watched --http "$page"
  local run=$!
  while sleep 0.05; do  # viewer --check opens the port for a moment, too
    { exec 8<>"/dev/tcp/${page/://}" && printf 'GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n' >&8 && cat <&8; } || true
  done >"$work/events" 2>/dev/null &
  reader=$!
  until has_event; do
    kill -0 $run 2>/dev/null || fail "the client that reads has got nothing"
  done
  never_reads >/dev/null 2>&1 &
  deaf=$!
  expect_code 0 $run
  kill $deaf $reader 2>/dev/null || true
  for file in run.lcm waymark/{map.pgm,trajectory.tum,markers.csv}; do
    cmp "$work/plain/$file" "$work/watched/$file" || fail "$file is not the same"
  done
  grep -h 'x real time' "$work/plain/logs/sim.log" "$work/watched/logs/sim.log" | grep simulated || true
  expect_nothing_left
}

declare -F "${2:?no case given}" >/dev/null || { echo "no case '$2'" >&2 && exit 2; }
"$2"
