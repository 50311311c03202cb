# What cmake --install lays out, and cpack packs: the library and its meshes, the interface for C and C++, the baker, what
# find_package and pkg-config read, licence and bill of materials.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(config ${CMAKE_INSTALL_LIBDIR}/cmake/Espalier)
set(made ${PROJECT_BINARY_DIR}/install)

install(TARGETS espalier EXPORT EspalierTargets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/plugin_api/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/espalier)
set(content ${PROJECT_BINARY_DIR}/content)
install(FILES ${content}/terminals.glb ${content}/roofs.glb ${content}/pieces.glb
  DESTINATION ${CMAKE_INSTALL_DATADIR}/espalier)
if(TARGET espalier-bake)
  install(TARGETS espalier-bake RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

install(EXPORT EspalierTargets NAMESPACE Espalier:: DESTINATION ${config})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/EspalierConfig.cmake.in ${made}/EspalierConfig.cmake
  INSTALL_DESTINATION ${config})
# Before 1.0 each minor version has an interface of its own.
write_basic_package_version_file(${made}/EspalierConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${made}/EspalierConfig.cmake ${made}/EspalierConfigVersion.cmake DESTINATION ${config})

# Wherever the folder is moved to, pkg-config finds it from its own.
file(RELATIVE_PATH prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${CMAKE_CURRENT_LIST_DIR}/espalier.pc.in ${made}/espalier.pc @ONLY)
install(FILES ${made}/espalier.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# Made of the library that is about to be shipped; a library that isn't known to permit that ends installing.
install(CODE "execute_process(
  COMMAND \"${PROJECT_SOURCE_DIR}/tools/lib/sbom\" \"$<TARGET_FILE:espalier>\" ${PROJECT_VERSION}
  OUTPUT_FILE \"${made}/espalier.spdx.json\" COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${made}/espalier.spdx.json DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR TGZ DEB)
set(CPACK_PACKAGE_NAME espalier)
set(CPACK_PACKAGE_VENDOR "The Espalier authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Grows plants and roofs over a game's own geometry, live, on the GPU")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "The Espalier authors <espalier@localhost>")
set(CPACK_DEBIAN_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
include(CPack)
