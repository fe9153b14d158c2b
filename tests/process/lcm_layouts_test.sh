#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# cmake/LcmLayouts.cmake: layouts of the fields that it knows; all others are errors that name the file.
#
# usage: tests/process/lcm_layouts_test.sh
set -euo pipefail

unset CDPATH
script=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/cmake/LcmLayouts.cmake
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() { echo "FAILED: $*" >&2 && exit 1; }

# layouts_of FIELDS: of a type a_t with these fields, and of b_t, which has one number.
layouts_of() {
  echo "package waymark; struct a_t { $1 }" >a_t.lcm
  echo "package waymark; struct b_t { double x; }" >b_t.lcm
  cmake -D HEADER=layouts.hpp -P "$script" -- a_t.lcm b_t.lcm >output 2>&1
}

# expect_field FIELDS LAYOUT: that of the last field.
expect_field() {
  layouts_of "$1" || fail "refused: $1: $(<output)"
  grep -qF "    {$2}};" layouts.hpp || fail "no layout {$2} of: $1: $(<layouts.hpp)"
}

expect_error() {
  rm -f layouts.hpp
  ! layouts_of "$1" || fail "accepted: $1"
  grep -q "$2" output || fail "no '$2' for: $1: $(<output)"
  [[ ! -e layouts.hpp ]] || fail "wrote a header of: $1"
}

expect_field "int16_t x;" ".element_bytes = 2, .count = 1"
expect_field "const int8_t A = 1, B = 2; float x[4][2]; // metres; per second
  const int8_t C = 3;" ".element_bytes = 4, .count = 8"
expect_field "int64_t utime; int32_t n; double x[n][3];" ".element_bytes = 24, .count_field = 1"
expect_field "int32_t n; string names[n];" ".kind = FieldLayout::Kind::kString, .count_field = 0"
expect_field "b_t b;" ".kind = FieldLayout::Kind::kStruct, .count_field = -1, .struct_fields = layouts::b_t"
b_line=$(grep -n " b_t\[\]" layouts.hpp | cut -d: -f1) a_line=$(grep -n " a_t\[\]" layouts.hpp | cut -d: -f1)
((b_line < a_line)) || fail "b_t is used before it is defined"

expect_error "double x[n]; int32_t n;" "a_t.lcm: the length 'n' of 'x' is no earlier int32_t"
expect_error "int64_t n; double x[n];" "a_t.lcm: the length 'n' of 'x' is no earlier int32_t"
expect_error "int32_t n[2]; double x[n];" "a_t.lcm: the length 'n' of 'x' is no earlier int32_t"
expect_error "int32_t n; double x[3][n];" "a_t.lcm: not understood: 'double x.3..n.'"
expect_error "int32_t n; int32_t m; double x[n][m];" "a_t.lcm: not understood: 'double x.n..m.'"
expect_error "b_t b[2];" "a_t.lcm: 'b': an array of constant length"
expect_error "double x, y;" "a_t.lcm: not understood: 'double x, y'"
expect_error "other_t x;" "unknown ones: a_t"
expect_error "a_t x;" "contain each other"
