# Components, flags and helpers shared by every target of the project.

# Throws out what is no component, and sets ADAMAS_TESTS_BY_DEFAULT.
function(adamas_check_components)
  foreach(component IN LISTS ADAMAS_COMPONENTS)
    if(NOT component IN_LIST ADAMAS_LIBRARIES AND NOT component STREQUAL "program")
      message(FATAL_ERROR "ADAMAS_COMPONENTS: expected some of ${ADAMAS_LIBRARIES};program, found '${component}'")
    endif()
  endforeach()
  set(tests ${PROJECT_IS_TOP_LEVEL})
  foreach(component IN LISTS ADAMAS_LIBRARIES ITEMS program)
    if(component STREQUAL "core" OR component IN_LIST ADAMAS_COMPONENTS)
      continue()
    endif()
    set(tests OFF)
    if("program" IN_LIST ADAMAS_COMPONENTS OR ADAMAS_BUILD_TESTS OR ADAMAS_BUILD_BENCHMARKS OR ADAMAS_BUILD_FUZZERS)
      message(FATAL_ERROR "ADAMAS_COMPONENTS: the program, the tests, the benchmarks and the fuzz targets need all "
                          "components, found none of the name '${component}'")
    endif()
  endforeach()
  set(ADAMAS_TESTS_BY_DEFAULT ${tests} PARENT_SCOPE)
endfunction()

# adamas_add_component(name folder): the folder, where the component is wanted.
function(adamas_add_component name folder)
  if(name STREQUAL "core" OR name IN_LIST ADAMAS_COMPONENTS)
    add_subdirectory(${folder})
  endif()
endfunction()

# What our own sources are compiled with, and nobody else's: warnings, and the root of the project as a folder of headers.
# Warnings are errors where CMAKE_COMPILE_WARNING_AS_ERROR says so, as the presets do.
macro(adamas_set_flags)
  set(ADAMAS_WARNINGS -Wall -Wextra -Wpedantic -Wshadow)
  foreach(warning IN ITEMS -Wnon-virtual-dtor -Wold-style-cast)
    list(APPEND ADAMAS_WARNINGS $<$<COMPILE_LANGUAGE:CXX>:${warning}>)
  endforeach()
  # g++ 12 sees overlaps and endless copies in std::string's operators that are not there (its bug 105651), at -O3 and in
  # precompiled headers copies beyond strings, too.
  set(gnu $<CXX_COMPILER_ID:GNU>)
  list(APPEND ADAMAS_WARNINGS $<${gnu}:-Wno-restrict> $<${gnu}:-Wno-stringop-overflow>
                              $<$<AND:${gnu},$<CONFIG:Release>>:-Wno-array-bounds>)
  # One rounding per operation: the same input gives the same bytes everywhere.
  add_compile_options(${ADAMAS_WARNINGS} -ffp-contract=off)
  include_directories(${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)

  # Otherwise g++ takes a tenth of its time to collect garbage, of which few sources have half a GiB.
  if(ADAMAS_SANITIZE)
    add_compile_options($<${gnu}:--param=ggc-min-heapsize=524288>)
  endif()

  # What those who link to us need too.
  add_library(adamas_flags INTERFACE)
  add_library(adamas::flags ALIAS adamas_flags)
  target_compile_features(adamas_flags INTERFACE cxx_std_20)
  if(ADAMAS_SANITIZE)
    target_compile_options(adamas_flags INTERFACE -fsanitize=${ADAMAS_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(adamas_flags INTERFACE -fsanitize=${ADAMAS_SANITIZE})
    if(ADAMAS_SANITIZE MATCHES "undefined")
      target_compile_options(adamas_flags INTERFACE -fno-sanitize-recover=undefined)
      # With these GCC checks each pointer at each use, which doubles what compiling takes. The address sanitizer tells of
      # null pointers as well, and preset fuzz, of Clang, has all checks. GCC also warns of what its checks alone make
      # possible; preset release has these warnings.
      target_compile_options(adamas_flags INTERFACE
        "$<$<CXX_COMPILER_ID:GNU>:-fno-sanitize=null,alignment,vptr;-Wno-array-bounds;-Wno-maybe-uninitialized>")
    endif()
  endif()
endmacro()

# adamas_precompile(target header...): the standard headers that nearly every source includes, fmt, and the headers given, are
# read once for the target. Sources include what they use all the same: scripts/lint reads them without this.
option(ADAMAS_PRECOMPILE_HEADERS "Read the standard headers once for each target" OFF)
function(adamas_precompile target)
  if(ADAMAS_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE ${PROJECT_SOURCE_DIR}/cmake/precompiled.h ${ARGN})
  endif()
endfunction()

# adamas_library(name folder... [EXCEPT folder] HEADERS header... | INTERNAL): the library adamas_<name> (alias adamas::<name>)
# of all sources in the folders. HEADERS: those of include/adamas that it stands behind; INTERNAL: it is not installed.
function(adamas_library name)
  cmake_parse_arguments(PARSE_ARGV 1 library INTERNAL EXCEPT HEADERS)
  set(sources)
  foreach(folder IN LISTS library_UNPARSED_ARGUMENTS)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.cpp
                                              ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/*.h)
    list(APPEND sources ${found})
  endforeach()
  if(library_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "/${library_EXCEPT}")
  endif()
  add_library(adamas_${name} STATIC ${sources})
  add_library(adamas::${name} ALIAS adamas_${name})
  # What include/adamas declares is seen from outside of a shared library, and nothing else is.
  set_target_properties(adamas_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_include_directories(adamas_${name} INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                      $<INSTALL_INTERFACE:include>)
  target_link_libraries(adamas_${name} PUBLIC adamas_flags)
  adamas_precompile(adamas_${name})
  if(NOT library_INTERNAL)
    set_property(TARGET adamas_${name} PROPERTY ADAMAS_HEADERS ${library_HEADERS})
    set_property(GLOBAL APPEND PROPERTY ADAMAS_INSTALLED adamas_${name})
  endif()
endfunction()

# adamas_add_shared_library(): adamas::shared, the file libadamas.so of all components that are built. An SO version is for
# programs that need not be linked again: while the first number of the version is 0, each second one is another.
function(adamas_add_shared_library)
  get_property(libraries GLOBAL PROPERTY ADAMAS_INSTALLED)
  set(no_source ${PROJECT_BINARY_DIR}/shared.cpp)
  file(CONFIGURE OUTPUT ${no_source} CONTENT "" @ONLY)
  add_library(adamas_shared SHARED ${no_source})
  add_library(adamas::shared ALIAS adamas_shared)
  foreach(library IN LISTS libraries)
    target_sources(adamas_shared PRIVATE $<TARGET_OBJECTS:${library}>)
    # Their libraries; they themselves are here already.
    target_link_libraries(adamas_shared PRIVATE ${library})
  endforeach()
  string(REGEX MATCH "^[0-9]+\\.[0-9]+" interface ${PROJECT_VERSION})
  set_target_properties(adamas_shared PROPERTIES OUTPUT_NAME adamas EXPORT_NAME shared VERSION ${PROJECT_VERSION}
    SOVERSION ${interface})
  target_link_options(adamas_shared PRIVATE -Wl,--exclude-libs,ALL -Wl,--no-undefined)
  target_include_directories(adamas_shared INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
                                                     $<INSTALL_INTERFACE:include>)
  target_compile_features(adamas_shared INTERFACE cxx_std_20)
  # A program without the sanitizers could not load a library that has them.
  if(ADAMAS_SANITIZE)
    target_compile_options(adamas_shared INTERFACE -fsanitize=${ADAMAS_SANITIZE})
    target_link_options(adamas_shared INTERFACE -fsanitize=${ADAMAS_SANITIZE})
  endif()
  install(TARGETS adamas_shared EXPORT adamas-shared-targets LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT adamas-shared-targets NAMESPACE adamas:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/adamas)
endfunction()
