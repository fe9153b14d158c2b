# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause
# Sourced by the scripts beside it: folders, errors, building, a port of one's own.
set -euo pipefail
unset CDPATH  # with it, cd prints where it went, and goes elsewhere
export LC_ALL=C.UTF-8  # numbers have a point, whatever the user's language

# shellcheck disable=SC2034  # used by the scripts that source this
readonly kExitFailed=1 kExitUsage=2 kExitDied=3 kExitTimeout=4  # as in exit_codes.hpp

# What the programs make in the folder of a row, beside config.toml.
# shellcheck disable=SC2034
readonly kRowResults=(map.pgm map.yaml map.png marker_layer.png plain.png scan.png markers.csv changes.csv
  trajectory.tum trajectory_final.tum graph.g2o covariance.csv odometry.tum slam.lcm timings.json findings.json
  metrics.json stations.csv)

script_name=$(basename "${0%.sh}")
deploy_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
if [[ -f $deploy_dir/../CMakeLists.txt ]]; then  # in the source tree
  source_dir=$(cd "$deploy_dir/.." && pwd)
  bin_dir=$source_dir/build/release
else  # installed: PREFIX/share/waymark/deploy
  source_dir=
  bin_dir=$(cd "$deploy_dir/../../.." && pwd)/bin
fi

say() { echo "$script_name: $*"; }

# die CODE SENTENCE
die() {
  local code=$1
  shift
  echo "$script_name: $*" >&2
  exit "$code"
}

usage_error() { die $kExitUsage "$* (see ${0##*/} --help)"; }

# no_arguments [ARGUMENT...]: of a script that takes none but --help.
no_arguments() {
  (($# > 0)) || return 0
  case $1 in
    --help | -h) print_usage && exit 0 ;;
    *) usage_error "unknown argument '$1'; there are none" ;;
  esac
}

# print_usage: the comment block at the top of the script is its manual.
print_usage() { sed -nE '3,/^(# shellcheck|[^#])/{/^# shellcheck/q; s/^# ?//p}' "$0"; }

# show_progress_bars: programs whose output goes through a pipe do not see the terminal behind it.
show_progress_bars() { [[ ! -t 2 ]] || export WAYMARK_PROGRESS_BAR=1; }

# need_value OPTION [VALUE...]: an option that takes a value has one.
need_value() { (($# >= 2)) || usage_error "$1 needs a value"; }

need_number() { [[ $2 =~ ^[0-9]+$ ]] || usage_error "$1 needs a whole number, not '$2'"; }

# need_decimal OPTION VALUE: 0 or more, without a unit.
need_decimal() {
  [[ $2 =~ ^([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]{1,2})?$ ]] ||
    usage_error "$1 needs a number that is not below 0, not '$2'"
}

need_count() { [[ $2 =~ ^0*[1-9][0-9]*$ ]] || usage_error "$1 needs a whole number above 0, not '$2'"; }

# need_row_name NAME: a folder of that name fits beside a run's own files.
need_row_name() {
  [[ $1 =~ ^[A-Za-z0-9_][A-Za-z0-9_-]{0,99}$ ]] ||
    usage_error "'$1' is no name for a row: letters, digits, _ and -, at most 100, the first one no -"
  case $1 in
    logs | recorded | finished | failed) usage_error "'$1' is no name for a row: a run's folder has a '$1' of its own" ;;
  esac
}

need_file() { [[ -f $1 && -r $1 ]] || die $kExitUsage "no readable file '$1'"; }

need_programs() {
  local name
  for name in "$@"; do
    [[ -x $bin_dir/$name ]] ||
      die $kExitUsage "no program $bin_dir/$name; build with: cmake --preset release && cmake --build --preset release --target ${name##*/}"
  done
}

# make_folder DIR: prints its absolute path; it exists and can be written to.
make_folder() {
  local error
  error=$(mkdir -p -- "$1" 2>&1) || die $kExitUsage "cannot make the folder '$1': ${error##*: }"
  [[ -w $1 ]] || die $kExitUsage "cannot write to the folder '$1'"
  (cd -- "$1" && pwd)
}

# protect_inputs INPUT...: refuses to read what is among old_files, which will be removed.
protect_inputs() {
  local file input
  # shellcheck disable=SC2154  # the script's
  for file in "${old_files[@]}"; do
    for input in "$@"; do
      [[ ! $file -ef $input ]] ||
        die $kExitUsage "'$input' belongs to the run that would be replaced; copy it, or give another folder with --out"
    done
  done
}

# count_down_ninja LOG: ninja's output as one line of progress, everything into LOG.
count_down_ninja() {
  local line last=$SECONDS
  while IFS= read -r line; do
    printf '%s\n' "$line"
    [[ $line =~ ^\[[0-9]+/[0-9]+\] ]] || continue
    if [[ -t 2 ]]; then
      printf '\r%s: building %s ' "$script_name" "${BASH_REMATCH[0]}" >&2
    elif ((SECONDS - last >= 15)); then
      last=$SECONDS
      say "building ${BASH_REMATCH[0]}" >&2
    fi
  done >"$1"
  [[ ! -t 2 ]] || printf '\r\e[K' >&2
}

# build PRESET [TARGET...]: configures and builds; shows the progress only, and the errors if it
# fails. Nothing to do for installed programs.
build() {
  [[ -n $source_dir ]] || return 0  # installed programs
  local preset=$1 folder=$source_dir/build/$1
  shift
  [[ $preset != ci ]] || folder=$source_dir/build/release
  if command -v ccache >/dev/null && [[ ! -v CMAKE_CXX_COMPILER_LAUNCHER ]]; then
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR=$source_dir
    export CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime  # as precompiled headers need
  fi
  mkdir -p "$folder"
  local log=$folder/build.log
  (cd "$source_dir" && cmake --preset "$preset") >"$log" 2>&1 || build_failed "$log"
  local targets=()
  (($# == 0)) || targets=(--target "$@")
  (cd "$source_dir" && cmake --build --preset "$preset" "${targets[@]}") 2>&1 </dev/null |
    count_down_ninja "$log" || build_failed "$log"
}

build_failed() {
  grep -A 40 -m 1 -E '^FAILED|CMake Error' "$1" >&2 || tail -n 40 "$1" >&2
  die $kExitFailed "the build failed; all of its output is in $1"
}

# make_shared_folder DIR: exists afterwards, for every user, even if another process makes it at the same moment.
make_shared_folder() {
  [[ -d $1 ]] || mkdir -m 1777 -- "$1" 2>/dev/null || [[ -d $1 ]] || die $kExitUsage "cannot make the folder '$1'"
}

# put_text FILE TEXT: whole or not at all.
put_text() { printf '%s\n' "$2" >"$1.tmp" && mv "$1.tmp" "$1"; }

# put_file FROM TO: a whole copy or none, also onto another disk, which may be full.
put_file() {
  if cp -- "$1" "$2.part" && mv -- "$2.part" "$2"; then return; fi
  rm -f -- "$2.part"
  die $kExitFailed "cannot write '$2'"
}

# take_port: sets lcm_url to a UDP port that no other stack on this machine has. The lock is a file
# descriptor that every process started later inherits, so the port is taken as long as one lives.
# (Multicast groups do not keep stacks apart in liblcm 1.3.1, ports do.)
take_port() {
  local folder=/tmp/waymark-ports port lock
  make_shared_folder $folder
  for ((port = 7700; port < 8700; ++port)); do
    lock=$folder/$port
    [[ -e $lock ]] || : >"$lock" 2>/dev/null || continue
    exec {port_lock}<"$lock" || continue
    if flock --nonblock "$port_lock" && ! port_in_use "$port"; then
      # shellcheck disable=SC2034  # the result
      lcm_url="udpm://239.255.76.67:$port?ttl=0"
      return
    fi
    exec {port_lock}<&-
  done
  die $kExitUsage "no free port between 7700 and 8699; give one with --lcm-url"
}

port_in_use() { cut -c 1-40 /proc/net/udp | grep -q "$(printf ':%04X ' "$1")"; }

# min_free_MB: a sweep wants this much free disk at any time.
min_free_MB() { echo "${WAYMARK_MIN_FREE_MB:-200}"; }
