# Finds LCM (Debian ships no CMake package, and its pkg-config file needs glib) and generates C++ types.
find_path(LCM_INCLUDE_DIR lcm/lcm.h REQUIRED)
find_library(LCM_LIBRARY lcm REQUIRED)
find_program(LCM_GEN lcm-gen REQUIRED)

add_library(lcm::lcm UNKNOWN IMPORTED)
set_target_properties(lcm::lcm PROPERTIES
  IMPORTED_LOCATION "${LCM_LIBRARY}"
  INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")

# waymark_add_lcm_types(TARGET FILE...): an interface library with <package>/<type>.hpp for each file.
function(waymark_add_lcm_types target)
  set(generated_dir "${CMAKE_CURRENT_BINARY_DIR}/generated")
  set(headers)
  foreach(file IN LISTS ARGN)
    get_filename_component(name "${file}" NAME_WE)
    file(READ "${file}" text)
    string(REGEX MATCH "package ([a-z_]+)" package_line "${text}")
    set(package "${CMAKE_MATCH_1}")
    set(header "${generated_dir}/${package}/${name}.hpp")
    add_custom_command(
      OUTPUT "${header}"
      COMMAND "${LCM_GEN}" --cpp --cpp-std c++11 --cpp-hpath "${generated_dir}" "${file}"
      DEPENDS "${file}"
      VERBATIM)
    list(APPEND headers "${header}")
  endforeach()
  add_custom_target(${target}_generate DEPENDS ${headers})
  add_library(${target} INTERFACE)
  add_dependencies(${target} ${target}_generate)
  target_include_directories(${target} SYSTEM INTERFACE "${generated_dir}")
  target_link_libraries(${target} INTERFACE lcm::lcm)
endfunction()

# waymark_add_lcm_layouts(TARGET FILE...): adds waymark/layouts.hpp, the wire layouts of all files, to a target of the above.
function(waymark_add_lcm_layouts target)
  set(header "${CMAKE_CURRENT_BINARY_DIR}/generated/waymark/layouts.hpp")
  set(script "${PROJECT_SOURCE_DIR}/cmake/LcmLayouts.cmake")
  add_custom_command(
    OUTPUT "${header}"
    COMMAND "${CMAKE_COMMAND}" -D "HEADER=${header}" -P "${script}" -- ${ARGN}
    DEPENDS ${ARGN} "${script}"
    VERBATIM)
  add_custom_target(${target}_layouts DEPENDS "${header}")
  add_dependencies(${target} ${target}_layouts)
endfunction()
