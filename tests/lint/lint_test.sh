#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every rule of lint.sh finds what it is there for, and leaves a clean tree alone.
set -euo pipefail

unset CDPATH
lint=$(cd "$(dirname "$0")" && pwd)/lint.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
licence='// SPDX-License-Identifier: BSD-3-Clause'

clean_tree() {
  rm -rf "$work/tree"
  mkdir -p "$work/tree"/{procs/slam/core,procs/detector,procs/common/messages,lcmtypes,tests,tools}
  cd "$work/tree"
  printf '%s\n#include <vector>\n' "$licence" >procs/slam/core/a.cpp
  printf '%s\n' "$licence" >procs/detector/b.hpp
  printf '%s\ninline constexpr Channel<image_t> kCamera{"CAMERA"};\n' "$licence" >procs/common/messages/channels.hpp
  printf '| %sCAMERA%s |\n' '`' '`' >lcmtypes/README.md
  printf 'struct a_t {\n    double x_m;  // [m]\n}\n' >lcmtypes/a_t.lcm
}

# breaks RULE FILE TEXT: with TEXT added to FILE the rule fails and names it; without, it passes.
breaks() {
  clean_tree
  "$lint" "$1" "$work/tree" || { echo "FAILED: $1 does not like the clean tree" && exit 1; }
  printf '%b\n' "$3" >>"$2"
  local output code=0
  output=$("$lint" "$1" "$work/tree") || code=$?
  [[ $code == 1 && $output == *"${4:-$2}"* ]] || { echo "FAILED: $1 does not mind: $3" && exit 1; }
}

breaks core_is_pure procs/slam/core/a.cpp '#include <lcm/lcm.h>'
breaks core_is_pure procs/slam/core/a.cpp '#include <waymark/tick_t.hpp>'
breaks core_is_pure procs/slam/core/a.cpp '#include "common/bus/bus.hpp"'
breaks core_is_pure procs/slam/core/a.cpp '#include <opencv2/core.hpp>'
breaks core_is_pure procs/slam/core/a.cpp 'auto now = std::chrono::steady_clock::now();'
breaks truth_is_hidden procs/detector/b.hpp 'on(channels::kTruePose);'
breaks lcm_fields_have_comments lcmtypes/a_t.lcm 'struct b_t {\n    double y_m;\n}'
breaks channel_names procs/common/messages/channels.hpp 'inline constexpr Channel<a_t> kA{"camera"};' camera
breaks channel_names procs/common/messages/channels.hpp 'inline constexpr Channel<a_t> kA{"NEW"};' NEW
breaks short_files procs/detector/b.hpp "$(printf '\\n%.0s' {1..400})"
breaks no_loose_ends procs/detector/b.hpp '// TO''DO: finish'
clean_tree && echo 'int x;' >tools/c.cpp
! "$lint" licence_in_every_file "$work/tree" >/dev/null || { echo "FAILED: licence_in_every_file" && exit 1; }
clean_tree && mkdir "$work/bin" && for tool in bash find sort dirname cat; do ln -s "$(command -v $tool)" "$work/bin"; done
for rule in formatted scripts_checked; do
  ! PATH=$work/bin "$lint" $rule "$work/tree" >/dev/null || { echo "FAILED: $rule holds without its tool" && exit 1; }
done
echo "all rules bite"
