# waymark_warnings: linked by every library and program of ours, never by generated code.
option(WAYMARK_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
add_library(waymark_warnings INTERFACE)
target_compile_options(waymark_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wold-style-cast
  -Woverloaded-virtual -Wnon-virtual-dtor
  $<$<BOOL:${WAYMARK_WARNINGS_AS_ERRORS}>:-Werror>)
