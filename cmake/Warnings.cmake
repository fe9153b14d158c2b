# waymark_warnings: linked by every library and program of ours, never by generated code.
# Errors in every preset, so that release and ci share their objects; not with another compiler than
# Debian 12's, whose new warnings must stop nobody.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12
    AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  set(known_compiler ON)
else()
  set(known_compiler OFF)
endif()
option(WAYMARK_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" ${known_compiler})
add_library(waymark_warnings INTERFACE)
target_compile_options(waymark_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wold-style-cast
  -Woverloaded-virtual -Wnon-virtual-dtor
  $<$<BOOL:${WAYMARK_WARNINGS_AS_ERRORS}>:-Werror>)
if(WAYMARK_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # takes instrumented code for uninitialised reads
  target_compile_options(waymark_warnings INTERFACE -Wno-maybe-uninitialized)
endif()
