#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs what is missing, builds with warnings as errors, and runs every test.
#
# usage: tests/run.sh
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../deploy/common.sh"

no_arguments "$@"

"$deploy_dir/install-deps.sh" --tests
build ci
cd "$source_dir"
tests/with_network.sh ctest --preset ci </dev/null
