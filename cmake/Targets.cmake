# Short forms, so that every folder's CMakeLists.txt reads the same way.

option(WAYMARK_UNITY "Compile the files of a folder as one" ON)

# waymark_unity(NAME [FILE...]): headers are read once per folder and not once per file. What files of a folder define in
# anonymous namespaces must have different names for that; FILEs that do not are compiled alone.
function(waymark_unity name)
  if(NOT WAYMARK_UNITY)
    return()
  endif()
  set_target_properties(${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${name} SOURCES)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  foreach(source IN LISTS sources)
    get_filename_component(folder "${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "${name}_${folder}" group)
    set_source_files_properties("${source}" PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()

# waymark_library(NAME [NUMERIC|PICTURES] SOURCES ... [ALONE ...] LIBRARIES ...): a static library of ours; headers are
# included from procs/. NUMERIC, PICTURES: as in Precompiled.cmake. ALONE: as for waymark_unity.
function(waymark_library name)
  cmake_parse_arguments(ARG "NUMERIC;PICTURES" "" "SOURCES;ALONE;LIBRARIES" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES} ${ARG_ALONE})
  target_include_directories(${name} PUBLIC "${PROJECT_SOURCE_DIR}/procs")
  target_link_libraries(${name} PUBLIC ${ARG_LIBRARIES} PRIVATE waymark_warnings)
  if(ARG_PICTURES)
    target_precompile_headers(${name} REUSE_FROM precompiled_pictures)
  elseif(ARG_NUMERIC)
    target_precompile_headers(${name} REUSE_FROM precompiled_numeric)
  else()
    target_compile_options(${name} PRIVATE ${waymark_plain_options})
    target_precompile_headers(${name} REUSE_FROM precompiled_plain)
  endif()
  waymark_unity(${name} ${ARG_ALONE})
endfunction()

add_custom_target(programs COMMENT "All installed programs")

# waymark_program(NAME SOURCES ... LIBRARIES ...): an installed program, built into the top of the build folder.
function(waymark_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} waymark_warnings)
  target_compile_options(${name} PRIVATE ${waymark_plain_options})
  target_precompile_headers(${name} REUSE_FROM precompiled_plain)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}")
  add_dependencies(programs ${name})
  install(TARGETS ${name} RUNTIME DESTINATION bin)
endfunction()

foreach(label unit property statistics process simulation)
  add_custom_target(${label}_tests)
endforeach()

# waymark_test(NAME [FAST] LABEL unit|property|statistics|process|simulation SOURCES ... [ALONE ...] LIBRARIES ...): one
# GoogleTest program, which is one test of CTest; the target LABEL_tests builds all of a label. statistics: accuracy over many
# drives, views or samples; minutes under sanitizers, so .ci/run leaves these without them (tests/nightly.sh does not). FAST:
# optimised, as all of statistics are, since the test itself loops over drives or solves equations.
function(waymark_test name)
  cmake_parse_arguments(ARG "FAST" "LABEL" "SOURCES;ALONE;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES} ${ARG_ALONE})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} test_own_folder GTest::gmock_main waymark_warnings)
  set(kind tests)
  if(ARG_FAST OR ARG_LABEL STREQUAL statistics)
    set(kind fast_tests)
  endif()
  target_compile_options(${name} PRIVATE ${waymark_${kind}_options})
  target_precompile_headers(${name} REUSE_FROM precompiled_${kind})
  target_compile_definitions(${name} PRIVATE
    WAYMARK_SOURCE_DIR="${PROJECT_SOURCE_DIR}" WAYMARK_BUILD_DIR="${PROJECT_BINARY_DIR}")
  waymark_unity(${name} ${ARG_ALONE})
  add_dependencies(${ARG_LABEL}_tests ${name})
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES LABELS ${ARG_LABEL} TIMEOUT 1500)
endfunction()
