# Message types for other languages: Python, and Java for lcm-spy.

# waymark_add_python_package(TARGET SOURCE_DIR FILE...): SOURCE_DIR and generated types of the files, in BUILD/python.
function(waymark_add_python_package target source_dir)
  set(package_dir "${PROJECT_BINARY_DIR}/python")
  file(GLOB_RECURSE scripts CONFIGURE_DEPENDS "${source_dir}/*.py" "${source_dir}/*.ipynb" "${source_dir}/*.md")
  add_custom_command(
    OUTPUT "${package_dir}/waymark/__init__.py"
    COMMAND "${CMAKE_COMMAND}" -E rm -rf "${package_dir}"
    COMMAND "${CMAKE_COMMAND}" -E copy_directory "${source_dir}" "${package_dir}"
    COMMAND "${LCM_GEN}" --python --ppath "${package_dir}" ${ARGN}
    DEPENDS ${ARGN} ${scripts}
    VERBATIM)
  add_custom_target(${target} ALL DEPENDS "${package_dir}/waymark/__init__.py")
  add_dependencies(programs ${target})
  install(DIRECTORY "${package_dir}/" DESTINATION "${CMAKE_INSTALL_DATADIR}/waymark/python" USE_SOURCE_PERMISSIONS
    PATTERN __pycache__ EXCLUDE PATTERN CMakeLists.txt EXCLUDE)
endfunction()

# waymark_add_spy_jar(TARGET FILE...): BUILD/waymark_types.jar, with which lcm-spy shows our messages. Not part of a usual
# build, and there only with a Java compiler and LCM's Java library (Debian: default-jdk-headless, liblcm-java).
function(waymark_add_spy_jar target)
  find_program(JAVAC javac)
  find_program(JAR jar)
  find_file(LCM_JAR lcm.jar PATHS /usr/share/java)
  if(NOT JAVAC OR NOT JAR OR NOT LCM_JAR)
    return()
  endif()
  set(java_dir "${PROJECT_BINARY_DIR}/java")
  set(sources)
  foreach(file IN LISTS ARGN)
    get_filename_component(name "${file}" NAME_WE)
    list(APPEND sources "${java_dir}/waymark/${name}.java")
  endforeach()
  add_custom_command(
    OUTPUT "${PROJECT_BINARY_DIR}/waymark_types.jar"
    COMMAND "${CMAKE_COMMAND}" -E rm -rf "${java_dir}"
    COMMAND "${LCM_GEN}" --java --jpath "${java_dir}" ${ARGN}
    COMMAND "${JAVAC}" -nowarn -cp "${LCM_JAR}" -d "${java_dir}/classes" ${sources}
    COMMAND "${JAR}" cf "${PROJECT_BINARY_DIR}/waymark_types.jar" -C "${java_dir}/classes" .
    DEPENDS ${ARGN}
    VERBATIM)
  add_custom_target(${target} DEPENDS "${PROJECT_BINARY_DIR}/waymark_types.jar")
endfunction()
