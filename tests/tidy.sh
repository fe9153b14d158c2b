#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# clang-tidy with the tree's .clang-tidy. All files take about an hour on two cores.
#
# usage: tests/tidy.sh [--newest N | FILE...]
#   --newest N  the N sources of procs/ and tools/ that the latest commits changed
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../deploy/common.sh"

cd "$source_dir"
sources=()
case ${1:-} in
  --help | -h) print_usage && exit 0 ;;
  --newest)
    need_value "$@" && need_count "$1" "$2"
    mapfile -t sources < <(git log -n 200 --name-only --format= --diff-filter=d -- 'procs/*.cpp' 'tools/*.cpp' |
      awk '!seen[$0]++' | while read -r file; do [[ ! -f $file ]] || echo "$file"; done | head -n "$2")
    ;;
  -*) usage_error "unknown option '$1'" ;;
  '') mapfile -t sources < <(git ls-files 'procs/*.cpp' 'tools/*.cpp') ;;
  *) sources=("$@") ;;
esac
command -v clang-tidy >/dev/null || die $kExitUsage "no clang-tidy here; deploy/install-deps.sh --tests installs it"

folder=$source_dir/build/tidy
mkdir -p "$folder"
{
  cmake -S . -B "$folder" -G Ninja -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DWAYMARK_UNITY=OFF -DWAYMARK_BUILD_TESTS=OFF &&
    cmake --build "$folder" --target waymark_lcmtypes_generate
} >"$folder/build.log" 2>&1 || build_failed "$folder/build.log"
say "${#sources[@]} files"
printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$(nproc)" \
  clang-tidy -p "$folder" --quiet --extra-arg=-Wno-unused-command-line-argument 2>/dev/null
