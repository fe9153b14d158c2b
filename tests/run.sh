#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds with warnings as errors, and runs every test.
#
# usage: tests/run.sh
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../deploy/common.sh"

no_arguments "$@"

# with_network COMMAND...: in a network of its own when this one has no way for multicast.
with_network() {
  if ip route get 239.255.76.67 >/dev/null 2>&1; then
    "$@"
  else
    say "no route for multicast here: the tests run in a private network"
    unshare --map-root-user --net sh -c \
      'ip link set lo up && ip route add 224.0.0.0/4 dev lo && exec "$@"' sh "$@"
  fi
}

"$deploy_dir/install-deps.sh" --tests
build ci
cd "$source_dir"
with_network ctest --preset ci --parallel 2 </dev/null
