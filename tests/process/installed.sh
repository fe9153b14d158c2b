# shellcheck shell=bash
# SPDX-License-Identifier: BSD-3-Clause
# Sourced by tests that run the real programs: the installed layout in a temporary folder $work, so that the programs of any
# build folder are under test. Needs $build_dir.
# shellcheck disable=SC2034,SC2154
unset CDPATH
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset LCM_DEFAULT_URL

mkdir -p "$work/share/waymark"
cp -r "$source_dir/deploy" "$work/share/waymark/"
ln -s "$build_dir" "$work/bin"
