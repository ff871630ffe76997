# The installed package: find_package(errbound).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/errbound)
install(EXPORT errbound_targets NAMESPACE errbound:: DESTINATION ${package_dir})
configure_package_config_file(cmake/errbound-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/errbound-config.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/errbound-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES CITATION.cff LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/errbound-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/errbound-config-version.cmake DESTINATION ${package_dir})
