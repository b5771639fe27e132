# TetGen as a library: the target TetGen::tet. Debian's package (libtet1.5-dev) brings no CMake files.
find_path(TETGEN_INCLUDE_DIR tetgen.h PATH_SUFFIXES tetgen)
find_library(TETGEN_LIBRARY NAMES tet tetgen)
mark_as_advanced(TETGEN_INCLUDE_DIR TETGEN_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TetGen REQUIRED_VARS TETGEN_LIBRARY TETGEN_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "it is in the package libtet1.5-dev, and -D ADAMAS_WITH_TETGEN=OFF builds without it")

if(TetGen_FOUND AND NOT TARGET TetGen::tet)
  add_library(TetGen::tet UNKNOWN IMPORTED)
  set_target_properties(TetGen::tet PROPERTIES IMPORTED_LOCATION "${TETGEN_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TETGEN_INCLUDE_DIR}" INTERFACE_COMPILE_DEFINITIONS TETLIBRARY)
endif()
