#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs the Debian packages that Waymark is built with; does nothing when none is missing.
#
# usage: install-deps.sh [--tests] [--fuzz] [--list]
#   --tests  also what only tests, benchmarks and sweeps need
#   --fuzz   also what only tests/fuzz/run.sh needs
#   --list   prints the packages, installs nothing
set -euo pipefail

packages=(
  cmake ninja-build g++ ccache             # build
  liblcm-dev liblcm-bin                    # transport, lcm-gen, lcm-logger, lcm-logplayer
  libopencv-dev libopencv-contrib-dev      # detector and viewer; contrib has ArUco
  libeigen3-dev libtbb-dev                 # slam: algebra, threads
  libmujoco-dev libosmesa6-dev             # sim: physics, rendering without a display
  libtomlplusplus-dev libcli11-dev libspdlog-dev libfmt-dev nlohmann-json3-dev
  libcpp-httplib-dev pkg-config            # viewer: the live page
  libturbojpeg0-dev libpng-dev             # camera frames, pictures of the map
  zlib1g-dev libbz2-dev                    # import of compressed logs, export
  libsqlite3-dev libzstd-dev liblz4-dev    # import of ROS bags
  libcairo2-dev                            # marker sheets as PDF
  libgtest-dev libgmock-dev                # the build is configured with its tests
  iproute2                                 # `ip`: a route for multicast where there is none
)
packages_for_tests=(
  clang-format clang-tidy shellcheck       # tests/lint
  libceres-dev                             # tests/benchmark/batch_limit
  parallel gnuplot-nox                     # sweeps: many runs at once, plots
  python3-numpy python3-matplotlib         # tests/python; where missing they are skipped
  lz4 zstd                                 # tests/python: bags compressed with them
  poppler-utils                            # tests of marker sheets: draws their PDF
  python3-rosbag python3-sensor-msgs python3-nav-msgs python3-tf2-msgs  # tests/python: a bag written by ROS itself
)
packages_for_fuzzing=(clang-16 libclang-rt-16-dev)  # Debian's default, 14, does not compile GCC 12's <ranges>

list=false
for option in "$@"; do
  case $option in
    --help | -h) sed -n '3,/^[^#]/s/^# \?//p' "$0" && exit 0 ;;
    --tests) packages+=("${packages_for_tests[@]}") ;;
    --fuzz) packages+=("${packages_for_fuzzing[@]}") ;;
    --list) list=true ;;
    *) echo "install-deps: unknown option '$option'; see --help" >&2 && exit 2 ;;
  esac
done
if $list; then
  printf '%s\n' "${packages[@]}"
  exit 0
fi

fail() {
  echo "install-deps: $*" >&2
  exit 2
}

command -v apt-get >/dev/null ||
  fail "this needs Debian 12 or a relative with apt; elsewhere install the like of: ${packages[*]}"

installed=$(dpkg-query -W -f='${Package} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null || true)
missing=()
for package in "${packages[@]}"; do
  [[ $'\n'$installed$'\n' == *$'\n'"$package installed"$'\n'* ]] || missing+=("$package")
done
((${#missing[@]} > 0)) || exit 0

as_root=()
if ((EUID != 0)); then
  command -v sudo >/dev/null ||
    fail "not root and no sudo; as root run: apt-get install --no-install-recommends ${missing[*]}"
  as_root=(sudo)
fi

echo "install-deps: installing ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
run_apt() {
  "${apt[@]}" "$@" >"$log" 2>&1 </dev/null && return
  tail -n 25 "$log" >&2
  fail "'apt-get $1' failed (see above); missing still: ${missing[*]}"
}
run_apt update
run_apt install --no-install-recommends "${missing[@]}"
echo "install-deps: ${#missing[@]} packages installed"
