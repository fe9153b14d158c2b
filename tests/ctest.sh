#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs built tests: twice as many at a time as there are cores, of which those that compute count as two (PROCESSORS).
#
# usage: tests/ctest.sh PRESET [OPTION of ctest...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${1:?usage: tests/ctest.sh PRESET [OPTION of ctest...]}
exec tests/with_network.sh ctest --preset "$preset" --parallel $((2 * $(nproc))) "${@:2}" </dev/null
