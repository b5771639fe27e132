# Installation: libraries, the headers of include/adamas, the program, and a package config for find_package(adamas).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/adamas)
get_property(libraries GLOBAL PROPERTY ADAMAS_INSTALLED)
set_target_properties(adamas_flags PROPERTIES EXPORT_NAME flags)
install(TARGETS adamas_flags ${libraries} EXPORT adamas-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
if(TARGET adamas)
  install(TARGETS adamas RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(TARGETS adamas_main RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR})
endif()
foreach(library IN LISTS libraries)
  string(REPLACE adamas_ "" component ${library})
  get_target_property(headers ${library} ADAMAS_HEADERS)
  list(TRANSFORM headers PREPEND ${PROJECT_SOURCE_DIR}/include/adamas/)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/adamas)
  list(APPEND components ${component})
endforeach()
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/docs/library.md
  DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(EXPORT adamas-targets NAMESPACE adamas:: DESTINATION ${package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/adamas-config.cmake.in
  ${PROJECT_BINARY_DIR}/adamas-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/adamas-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/adamas-config.cmake ${PROJECT_BINARY_DIR}/adamas-config-version.cmake
  DESTINATION ${package_folder})
