# Installation: libraries with their headers, the program, and a package config for find_package(adamas).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/adamas)
get_property(libraries GLOBAL PROPERTY ADAMAS_LIBRARIES)
set_target_properties(adamas_flags PROPERTIES EXPORT_NAME flags)
install(TARGETS adamas_flags ${libraries} EXPORT adamas-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS adamas RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS adamas_main adamas_reference RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR})
foreach(module core interfaces isosurface datasets)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/${module}/*.h)
  foreach(header IN LISTS headers)
    # Those with headers of other libraries are for sources beside them: who links to us need not have VTK's.
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} foreign REGEX "^#include <(vtk|hdf5|png|CGAL/|Eigen/|cairo|tbb/)")
    if(foreign)
      continue()
    endif()
    get_filename_component(folder ${header} DIRECTORY)
    if(folder MATCHES "^interfaces/reference")
      continue()
    endif()
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/adamas/${folder})
  endforeach()
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT adamas-targets NAMESPACE adamas:: DESTINATION ${package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/adamas-config.cmake.in
  ${PROJECT_BINARY_DIR}/adamas-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/adamas-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/adamas-config.cmake ${PROJECT_BINARY_DIR}/adamas-config-version.cmake
  DESTINATION ${package_folder})
