# For scripts that CTest calls with BUILD, SOURCE, FOLDER, SCRATCH, COMPILER, C_COMPILER and BUILD_TYPE.

# run(command...): leaves in `output` what it says; stops where it fails.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    string(JOIN " " command ${ARGN})
    message(FATAL_ERROR "failed (${result}): ${command}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# configure(source build option...)
function(configure source build)
  run(${CMAKE_COMMAND} -S ${source} -B ${build} -G Ninja -D CMAKE_CXX_COMPILER=${COMPILER}
    -D CMAKE_C_COMPILER=${C_COMPILER} -D CMAKE_BUILD_TYPE=${BUILD_TYPE} ${ARGN})
endfunction()

# What core, isosurface, timevarying and datasets can do without.
foreach(package VTK CGAL Eigen3 OpenMesh PkgConfig PNG TIFF ZLIB BZip2 CLI11 nlohmann_json GTest benchmark TetGen)
  list(APPEND without_others -D CMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
