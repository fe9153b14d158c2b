#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Rules of the source tree that no compiler checks. Exit codes: 0 kept, 1 broken, 77 not checked here.
#
# usage: tests/lint/lint.sh RULE|--list [SOURCE_DIR [BUILD_DIR]]
set -eu  # no pipefail: grep finding nothing is good news

readonly kMaxLines=400 kSkipped=77
rule=${1:?usage: lint.sh RULE [SOURCE_DIR [BUILD_DIR]]}
unset CDPATH
root=${2:-$(cd "$(dirname "$0")/../.." && pwd)}
build_dir=${3:-}
cd "$root"

# files FOLDERS PATTERNS: our files, by name; in the tree only, never in build folders or runs.
files() {
  local folders=$1 pattern names=()
  shift
  for pattern in "$@"; do names+=(-o -name "$pattern"); done
  # shellcheck disable=SC2086  # several folders
  find $folders \( -path ./build -o -path ./runs -o -path ./.git -o -path ./tests/data \) -prune -o \
    -type f \( "${names[@]:1}" \) -print | sort
}

# none_of MESSAGE: fails when there is something on standard input, which is then shown.
none_of() {
  local found
  found=$(cat)
  [[ -z $found ]] || { printf '%s\n%s\n' "$1:" "$found" && exit 1; }
}

cores() { find procs -type d -path 'procs/*/core' 2>/dev/null; }

# A core takes values and returns values: no bus, no messages, no log, no files, no clock.
core_is_pure() {
  files "$(cores)" '*.hpp' '*.cpp' | xargs -r grep -nHE \
    '#include [<"](lcm/|waymark/|spdlog/|fstream|filesystem|iostream|thread|common/(bus|command_line|lockstep|log|logging|messages|node|runtime)/|opencv2/(highgui|viz))|(system|steady|high_resolution)_clock' |
    none_of "not for a core"
  files procs/slam/core '*.hpp' '*.cpp' | xargs -r grep -nHE '#include <(opencv2|mujoco|nlohmann|tbb|oneapi|fmt|toml)' |
    none_of "procs/slam/core is Eigen and the standard library"
}

# The same for what headers include: from the compiler's own list.
core_is_pure_with_all_it_includes() {
  [[ -f $build_dir/build.ninja ]] || exit $kSkipped
  ninja -C "$build_dir" -t deps | awk '
    /^[^ ].*: #deps/ { object = $1 ~ /^procs\/.*\/core\// ? $1 : ""; objects += object != "" }
    object && /\/lcm\/|\/generated\/waymark\/|\/spdlog\/|opencv2\/(highgui|viz)/ { print object, $1 }
    object ~ /^procs\/slam/ && /\/(opencv2|mujoco|tbb|nlohmann)\// { print object, $1 }
    END { if (!objects) print "no object of a core in", ENVIRON["PWD"] }' |
    none_of "objects of a core that depend on what is not for a core"
}

# slam and detector must not know the truth, nor the files it is in.
truth_is_hidden() {
  files "procs/slam procs/detector" '*.hpp' '*.cpp' 'CMakeLists.txt' |
    xargs -r grep -nHE 'TRUE_POSE|kTruePose|truth\.tum|truth_markers|procs/sim|"sim/' | none_of "slam and detector know the truth"
}

lcm_fields_have_comments() {
  files lcmtypes '*.lcm' | xargs -r grep -nHE '^    [a-z].*;\s*$' | grep -v ':    const ' |
    none_of "fields without a comment (unit, frame, meaning)"
}

channel_names() {
  local names
  names=$(sed -nE 's/.*inline constexpr Channel<.*\{"([^"]*)"\}.*/\1/p' procs/common/messages/channels.hpp)
  [[ -n $names ]] || { echo "no channels found in channels.hpp" && exit 1; }
  grep -vxE '[A-Z0-9_]+' <<<"$names" | none_of "channel names are [A-Z0-9_]+"
  local name
  for name in $names; do grep -q "^| \`$name\`" lcmtypes/README.md || echo "$name"; done |
    none_of "channels that lcmtypes/README.md does not list"
}

formatted() {
  command -v clang-format >/dev/null || { echo "no clang-format here; deploy/install-deps.sh --tests installs it" && exit 1; }
  files "procs tools tests" '*.hpp' '*.cpp' | xargs -r -P 2 -n 20 clang-format --dry-run --Werror
}

scripts_checked() {
  command -v shellcheck >/dev/null || { echo "no shellcheck here; deploy/install-deps.sh --tests installs it" && exit 1; }
  files "deploy tests tools" '*.sh' | xargs -r shellcheck -x .ci/run
}

short_files() {
  files . '*.hpp' '*.cpp' '*.sh' '*.py' '*.lcm' '*.cmake' CMakeLists.txt | xargs -r wc -l |
    awk -v max=$kMaxLines '$1 > max && $2 != "total"' | none_of "files with more than $kMaxLines lines"
}

licence_in_every_file() {
  files . '*.hpp' '*.cpp' '*.sh' | xargs -r awk '
    FNR == 1 { if (file && !found) print file; file = FILENAME; found = 0 }
    FNR <= 2 && /SPDX-License-Identifier: BSD-3-Clause/ { found = 1 }
    END { if (file && !found) print file }' | none_of "files without a licence in their first two lines"
}

no_loose_ends() {
  files . '*.hpp' '*.cpp' '*.sh' '*.lcm' '*.toml' '*.md' CMakeLists.txt | grep -v tests/lint/ |
    xargs -r grep -nHwE 'TODO|FIXME|XXX|HACK' | none_of "loose ends"
}

if [[ $rule == --list ]]; then
  sed -nE 's/^([a-z_]+)\(\) \{.*$/\1/p' tests/lint/lint.sh | grep -vxE 'files|none_of|cores'
else
  declare -F "$rule" >/dev/null || { echo "no rule '$rule'" && exit 2; }
  "$rule"
fi
