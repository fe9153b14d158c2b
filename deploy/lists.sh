# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause
# Sourced by scripts that run many seeds through many estimators: --seeds and --estimators become lists.
# shellcheck disable=SC2154  # seeds, estimators: the script's

readonly kMaxSeedDigits=15  # run.seed goes up to 1e15
readonly kMaxSeeds=100000   # more is a slip of the keys

# split LIST: sets `parts`, which are between commas or blanks.
split() { IFS=$', \t\n' read -r -d '' -a parts < <(printf '%s\0' "$1"); }

# expand_seeds: sets seed_list.
expand_seeds() {
  local part parts
  local -A seen=()
  seed_list=()
  split "$seeds"
  for part in "${parts[@]}"; do
    [[ $part =~ ^([0-9]+)(-([0-9]+))?$ ]] || usage_error "--seeds needs a list like 1-20 or 1,3,7-9, not '$seeds'"
    add_seeds "${BASH_REMATCH[1]}" "${BASH_REMATCH[3]:-${BASH_REMATCH[1]}}"
  done
  ((${#seed_list[@]} > 0)) || usage_error "no seed in --seeds '$seeds'"
}

# add_seeds FIRST LAST: none twice, for two jobs would write to one folder.
add_seeds() {
  local seed
  ((${#1} <= kMaxSeedDigits && ${#2} <= kMaxSeedDigits)) ||
    usage_error "--seeds: a seed has at most $kMaxSeedDigits digits, unlike one in '$seeds'"
  ((10#$1 <= 10#$2)) || usage_error "--seeds: '$1-$2' goes backwards; the smaller one comes first"
  ((10#$2 - 10#$1 < kMaxSeeds)) || usage_error "--seeds: '$1-$2' are more than $kMaxSeeds seeds"
  for ((seed = 10#$1; seed <= 10#$2; ++seed)); do
    [[ ! -v seen[$seed] ]] || usage_error "--seeds: $seed is there twice"
    seen[$seed]=1 seed_list+=("$seed")
  done
}

# expand_rows: sets rows, lines of NAME ESTIMATOR KEY=VALUE...
expand_rows() {
  local part parts name
  local -A seen=()
  rows=()
  split "$estimators"
  for part in "${parts[@]}"; do
    name=${part%%=*} part=${part#*=}
    need_row_name "$name"
    [[ ! -v seen[$name] ]] ||
      usage_error "--estimators: two rows are called '$name'; name one of them: NAME=ESTIMATOR:KEY=VALUE:..."
    seen[$name]=1 rows+=("$name ${part//:/ }")
  done
  ((${#rows[@]} > 0)) || usage_error "no row in --estimators '$estimators'"
}

# check_rows [KEY=VALUE...]: wrong estimators and settings, here those of every row, are found now, not after an hour.
check_rows() {
  local row words setting options
  for row in "${rows[@]}"; do
    read -r -a words <<<"$row"
    options=(--set "slam.estimator=${words[1]:-}")
    for setting in "$@" "${words[@]:2}"; do options+=(--set "$setting"); done
    "$bin_dir/waymark-slam" "${options[@]}" --dump-config >/dev/null || exit $?
  done
}
