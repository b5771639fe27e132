# Flags and helpers shared by every target of the project.

add_library(adamas_flags INTERFACE)
add_library(adamas::flags ALIAS adamas_flags)
target_compile_features(adamas_flags INTERFACE cxx_std_20)
# One rounding per operation: the same input gives the same bytes everywhere.
target_compile_options(adamas_flags INTERFACE -ffp-contract=off)
set(ADAMAS_WARNINGS -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Werror)
target_compile_options(adamas_flags INTERFACE "$<BUILD_INTERFACE:${ADAMAS_WARNINGS}>")
# g++ 12 sees overlaps in std::string's operator+ that are not there (its bug 105651).
target_compile_options(adamas_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(ADAMAS_SANITIZE)
  target_compile_options(adamas_flags INTERFACE -fsanitize=${ADAMAS_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(adamas_flags INTERFACE -fsanitize=${ADAMAS_SANITIZE})
  if(ADAMAS_SANITIZE MATCHES "undefined")
    target_compile_options(adamas_flags INTERFACE -fno-sanitize-recover=undefined)
  endif()
endif()

# adamas_library(name folder... [EXCEPT folder] [INTERNAL]): the library adamas_<name> (alias adamas::<name>) of all sources
# in the folders; INTERNAL: it is not installed.
function(adamas_library name)
  cmake_parse_arguments(PARSE_ARGV 1 library INTERNAL EXCEPT "")
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
  set_target_properties(adamas_${name} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(adamas_${name} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                   $<INSTALL_INTERFACE:include/adamas>)
  target_link_libraries(adamas_${name} PUBLIC adamas_flags)
  if(NOT library_INTERNAL)
    set_property(GLOBAL APPEND PROPERTY ADAMAS_LIBRARIES adamas_${name})
  endif()
endfunction()
