# What `cmake --install` puts where, and the Debian package made of it.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/slideway)

# The library: find_package(slideway), then slideway::slideway, which is all rooms.
install(TARGETS slideway_rooms ${rooms} EXPORT slideway ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY include/slideway DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        FILES_MATCHING PATTERN "*.hpp")
install(EXPORT slideway NAMESPACE slideway:: FILE slidewayTargets.cmake DESTINATION ${config_dir})
configure_package_config_file(cmake/slidewayConfig.cmake.in slidewayConfig.cmake
                              INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(slidewayConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/slidewayConfig.cmake
        ${PROJECT_BINARY_DIR}/slidewayConfigVersion.cmake DESTINATION ${config_dir})

# The program with its documents. Problems stand beside their data as in the sources.
install(TARGETS slideway RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# Manual pages and completions, where the build makes them. Debian's zsh looks elsewhere than others.
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION ${CMAKE_INSTALL_DATADIR} OPTIONAL
        PATTERN zsh EXCLUDE)
set(zsh_dir zsh/site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL /usr)
  set(zsh_dir zsh/vendor-completions)
endif()
install(DIRECTORY ${PROJECT_BINARY_DIR}/share/zsh/site-functions/
        DESTINATION ${CMAKE_INSTALL_DATADIR}/${zsh_dir} OPTIONAL)
# `serve` among the desktop's programs.
install(FILES cmake/desktop/slideway.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES cmake/desktop/slideway.svg
        DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
include(cmake/sbom.cmake)
install(FILES README.md CHANGELOG.md SECURITY.md THIRD_PARTY.md ${PROJECT_BINARY_DIR}/slideway.spdx.json
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY problems data DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples
        FILES_MATCHING PATTERN "*.toml" PATTERN "*.csv" PATTERN "*.md")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "The slideway authors")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "g++, cmake, libceres-dev, libcpp-httplib-dev, libeigen3-dev, libmuparser-dev, libpugixml-dev, libssl-dev, libtomlplusplus-dev, libzip-dev, pkg-config")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"slideway finds out from profilometer traces of a face-turned workpiece, or from
readings taken along the slide, which straightness and squareness errors the
carriages of the lathe have, with uncertainties, and whether anything else made
the face.

The program, the C++ library (static, with its headers and CMake package) and
the Python module.")
if(SLIDEWAY_PYTHON)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PACKAGE_DEPENDS
      "python3 (>= 3.${Python3_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/postinst
      ${PROJECT_SOURCE_DIR}/cmake/debian/prerm)
endif()
include(CPack)
