# Script: writes the wire layouts of LCM types (common/messages/layout.hpp) as a C++ header.
# usage: cmake -D HEADER=OUT.hpp -P LcmLayouts.cmake -- FILE.lcm...
#
# Understands what our types consist of: one struct per file, in package waymark, of numbers, strings and other structs; arrays
# of constant length of numbers, and arrays whose first length is an earlier int32_t. Anything else is an error.
cmake_minimum_required(VERSION 3.25)

set(bytes_of_boolean 1)
set(bytes_of_byte 1)
set(bytes_of_int8_t 1)
set(bytes_of_int16_t 2)
set(bytes_of_int32_t 4)
set(bytes_of_int64_t 8)
set(bytes_of_float 4)
set(bytes_of_double 8)

# add_field(STATEMENT): appends to `fields` (C++), to `counts` (the name, if it may be a length; else "-") and `used_structs`.
macro(add_field statement)
  if(NOT "${statement}" MATCHES "^([a-zA-Z0-9_]+) ([a-zA-Z0-9_]+)(\\[([a-zA-Z0-9_]+)\\])?((\\[[0-9]+\\])*)$")
    message(FATAL_ERROR "${file}: not understood: '${statement}'")
  endif()
  set(type "${CMAKE_MATCH_1}")
  set(name "${CMAKE_MATCH_2}")
  set(length "${CMAKE_MATCH_4}")
  string(REGEX MATCHALL "[0-9]+" other_lengths "${CMAKE_MATCH_5}")
  set(constant 1)
  set(count_field -1)
  if(length MATCHES "^[0-9]+$")
    set(constant ${length})
  elseif(NOT length STREQUAL "")
    list(FIND counts "${length}" count_field)
    if(count_field LESS 0)
      message(FATAL_ERROR "${file}: the length '${length}' of '${name}' is no earlier int32_t")
    endif()
  endif()
  foreach(other IN LISTS other_lengths)
    math(EXPR constant "${constant} * ${other}")
  endforeach()
  if(DEFINED bytes_of_${type} AND count_field LESS 0)
    list(APPEND fields "{.element_bytes = ${bytes_of_${type}}, .count = ${constant}}")
  elseif(DEFINED bytes_of_${type})
    math(EXPR row_bytes "${constant} * ${bytes_of_${type}}")
    list(APPEND fields "{.element_bytes = ${row_bytes}, .count_field = ${count_field}}")
  elseif(NOT constant EQUAL 1)
    message(FATAL_ERROR "${file}: '${name}': an array of constant length has to be one of numbers")
  elseif(type STREQUAL "string")
    list(APPEND fields "{.kind = FieldLayout::Kind::kString, .count_field = ${count_field}}")
  else()
    list(APPEND used_structs "${type}")
    list(APPEND fields
      "{.kind = FieldLayout::Kind::kStruct, .count_field = ${count_field}, .struct_fields = layouts::${type}}")
  endif()
  if(type STREQUAL "int32_t" AND length STREQUAL "")
    list(APPEND counts "${name}")
  else()
    list(APPEND counts "-")
  endif()
endmacro()

# Reads one file: sets layout_of_TYPE (C++), structs_in_TYPE, and appends to `types`.
macro(read_type)
  file(READ "${file}" text)
  string(REGEX REPLACE "//[^\n]*" "" text "${text}")
  string(REGEX REPLACE "const [^;]*;" "" text "${text}")
  string(REGEX REPLACE "[ \t\n]+" " " text "${text}")
  if(NOT text MATCHES "^ ?package waymark; ?struct ([a-zA-Z0-9_]+) {(.*)} ?$")
    message(FATAL_ERROR "${file}: expected 'package waymark; struct NAME { ... }'")
  endif()
  set(type_name "${CMAKE_MATCH_1}")
  set(statements "${CMAKE_MATCH_2}")  # a list, as CMake separates elements by semicolons
  set(fields)
  set(counts)
  set(used_structs)
  foreach(statement IN LISTS statements)
    string(STRIP "${statement}" statement)
    if(NOT statement STREQUAL "")
      add_field("${statement}")
    endif()
  endforeach()
  list(JOIN fields ",\n    " joined)
  set(layout_of_${type_name} "inline constexpr FieldLayout ${type_name}[] = {\n    ${joined}};\n")
  set(structs_in_${type_name} ${used_structs})
  list(APPEND types "${type_name}")
endmacro()

set(types)
set(is_file FALSE)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(index RANGE ${last})
  if(is_file)
    set(file "${CMAKE_ARGV${index}}")
    read_type()
  elseif(CMAKE_ARGV${index} STREQUAL "--")
    set(is_file TRUE)
  endif()
endforeach()

set(includes)
set(layouts)
set(rows)
set(written)
set(waiting ${types})
while(waiting)
  set(later)
  foreach(type IN LISTS waiting)
    set(missing ${structs_in_${type}})
    list(REMOVE_ITEM missing "" ${written})
    if(missing)
      list(APPEND later ${type})
    else()
      list(APPEND written ${type})
      string(APPEND layouts "${layout_of_${type}}")
      string(APPEND layouts "static_assert(std::size(${type}) <= kMaxFields);\n\n")
    endif()
  endforeach()
  if(later STREQUAL waiting)
    message(FATAL_ERROR "types that contain each other, or unknown ones: ${waiting}")
  endif()
  set(waiting ${later})
endwhile()
foreach(type IN LISTS types)
  string(APPEND includes "#include \"waymark/${type}.hpp\"\n")
  string(APPEND rows "      {waymark::${type}::getHash(), layouts::${type}},\n")
endforeach()

file(WRITE "${HEADER}" "// Made from lcmtypes/*.lcm by cmake/LcmLayouts.cmake.
#pragma once

#include \"common/messages/layout.hpp\"

${includes}
#include <cstdint>
#include <iterator>
#include <map>

namespace waymark::layouts {

${layouts}/// Layouts by fingerprint.
inline const std::map<std::int64_t, StructLayout>& of_all_types() {
  static const std::map<std::int64_t, StructLayout> layouts{
${rows}  };
  return layouts;
}

}  // namespace waymark::layouts
")
