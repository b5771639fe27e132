include(${CMAKE_CURRENT_LIST_DIR}/scratch_build.cmake)

file(REMOVE_RECURSE ${SCRATCH})
set(options -D ADAMAS_COMPONENTS=core,isosurface,timevarying ${without_others})
configure(${SOURCE} ${SCRATCH}/alone ${options})
run(${CMAKE_COMMAND} --build ${SCRATCH}/alone --target core/CMakeFiles/adamas_core.dir/base/parallel.cpp.o)
configure(${FOLDER}/embedding ${SCRATCH}/embedded ${options} -D ADAMAS_SOURCE=${SOURCE}
  -D CMAKE_COMPILE_WARNING_AS_ERROR=ON)
run(${CMAKE_COMMAND} --build ${SCRATCH}/embedded --target CMakeFiles/embedding.dir/embedding.cpp.o)
file(REMOVE_RECURSE ${SCRATCH})
