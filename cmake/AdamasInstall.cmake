# Installation: libraries with their headers, the program, and a package config for find_package(adamas).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY ADAMAS_LIBRARIES)
install(TARGETS adamas_flags ${libraries} EXPORT adamas-targets)
install(TARGETS adamas RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(module core interfaces datasets)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${module} DESTINATION include/adamas FILES_MATCHING PATTERN "*.h")
endforeach()
set_target_properties(adamas_flags PROPERTIES EXPORT_NAME flags)
install(EXPORT adamas-targets NAMESPACE adamas:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/adamas)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/adamas-config.cmake.in
  ${PROJECT_BINARY_DIR}/adamas-config.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/adamas)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/adamas-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/adamas-config.cmake ${PROJECT_BINARY_DIR}/adamas-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/adamas)
