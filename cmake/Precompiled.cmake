# Precompiled headers: what most files of a kind open to anyway. Sources go on including what they use, and compile
# without these as well (-DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON). One per kind of code:
#   numeric   loops over beams, cells and equations: fully optimised
#   pictures  loops over pixels: the same, with OpenCV
#   plain     everything else, which runs a few times per message or file: optimised less, which saves a third of the time
#   tests     not optimised, with GoogleTest; fast_tests: plain, with GoogleTest

# GCC takes a precompiled header only where the definitions are the same as where it was made.
add_compile_definitions(FMT_SHARED)

# GCC warns wrongly of std::optional at -O1.
set(waymark_plain_options "$<$<CONFIG:Release>:-O1;-Wno-maybe-uninitialized>")

# Tests spend their time in our libraries, so most of them are not optimised. AddressSanitizer looks for references that
# outlive their scope in our libraries only: in tests, whose macros open a scope each, that check takes up to two fifths of the
# compiler's time.
set(waymark_tests_options -O0 -Wno-maybe-uninitialized)
set(waymark_fast_tests_options ${waymark_plain_options})
if(WAYMARK_SANITIZE MATCHES address)
  list(APPEND waymark_tests_options -fno-sanitize-address-use-after-scope)
  list(APPEND waymark_fast_tests_options -fno-sanitize-address-use-after-scope)
endif()

function(waymark_precompiled name)
  cmake_parse_arguments(ARG "" "" "HEADERS;LIBRARIES;OPTIONS" ${ARGN})
  file(CONFIGURE OUTPUT "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp" CONTENT "")
  add_library(${name} OBJECT "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp")
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} waymark_warnings)
  target_compile_options(${name} PRIVATE ${ARG_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${ARG_HEADERS})
endfunction()

set(headers
  <algorithm> <array> <cmath> <cstdint> <deque> <filesystem> <functional> <limits> <map> <memory> <numbers> <optional>
  <set> <span> <sstream> <string> <string_view> <utility> <variant> <vector>
  <Eigen/Cholesky> <Eigen/Core> <Eigen/Eigenvalues> <Eigen/Geometry> <Eigen/LU> <fmt/format.h>)
waymark_precompiled(precompiled_numeric HEADERS ${headers} LIBRARIES Eigen3::Eigen fmt::fmt)
waymark_precompiled(precompiled_pictures
  HEADERS ${headers} <opencv2/core.hpp> <opencv2/imgproc.hpp>
  LIBRARIES Eigen3::Eigen fmt::fmt opencv_core opencv_imgproc)
waymark_precompiled(precompiled_plain
  HEADERS ${headers}
  LIBRARIES Eigen3::Eigen fmt::fmt
  OPTIONS ${waymark_plain_options})
