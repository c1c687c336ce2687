# cpack --config build/release/CPackConfig.cmake makes Debian packages of what is installed: `biotomy`,
# the programs, and `libbiotomy-dev`, the library. They belong to the release of Debian on which they
# were built.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME biotomy)
set(CPACK_PACKAGE_CONTACT "The authors of Biotomy")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_COMPONENTS_ALL Unspecified development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME biotomy)
set(CPACK_DEBIAN_UNSPECIFIED_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SECTION science)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers, systemd | systemd-standalone-tmpfiles")
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_RECOMMENDS "ffmpeg, systemd, udev")
set(scripts postinst prerm postrm)
list(TRANSFORM scripts PREPEND ${PROJECT_SOURCE_DIR}/packaging/debian/)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_CONTROL_EXTRA ${scripts})
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# What BiotomyConfig.cmake looks for.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libbiotomy-dev)
set(CPACK_DEBIAN_DEVELOPMENT_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
string(CONCAT CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "pkg-config, libopencv-dev, nlohmann-json3-dev, libjpeg-dev, libpng-dev, libtiff-dev, zlib1g-dev, "
  "libtbb-dev, libssl-dev, libtomlplusplus-dev, libblosc-dev, libdeflate-dev, libhwy-dev, libisal-dev, "
  "libzstd-dev")
include(CPack)
