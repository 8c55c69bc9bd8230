# `cpack` makes one .deb (scripts/package does it all): programs, settings, message types, headers and libraries.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME evit)
set(CPACK_PACKAGE_CONTACT "EVIT maintainers <maintainers@users.noreply.h-seed-355f17fe.example>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "event-inertial 6-DoF tracking in known semi-dense maps")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "An event camera and an IMU, tracked against a semi-dense point cloud by four services over LCM.
The package holds the evit command, the services, a systemd unit, the message types for C++, Java and
Python, and the algorithms as a CMake package.")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# Libraries by what the programs link (dpkg-shlibdeps); the rest by what a user may want besides running.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "liblcm-bin, liblcm-java, libjchart2d-java, default-jre-headless")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "cmake, g++, libceres-dev, libeigen3-dev, liblcm-dev, libopencv-dev, python3-numpy")

# /etc/default/evit is the administrator's: dpkg asks before it replaces an edited one.
set(ETC ${CMAKE_BINARY_DIR}/package/etc)
configure_file(${PROJECT_SOURCE_DIR}/procman/evit.default ${ETC}/default/evit COPYONLY)
file(WRITE ${CMAKE_BINARY_DIR}/package/conffiles "/etc/default/evit\n")
file(WRITE ${CMAKE_BINARY_DIR}/package/postinst "#!/bin/sh\nset -e\n[ ! -d /run/systemd/system ] || systemctl daemon-reload\n")
file(WRITE ${CMAKE_BINARY_DIR}/package/prerm "#!/bin/sh\nset -e\n[ \"$1\" != remove ] || [ ! -d /run/systemd/system ] || systemctl disable --now evit.service\n")
file(CHMOD ${CMAKE_BINARY_DIR}/package/postinst ${CMAKE_BINARY_DIR}/package/prerm
     PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_INSTALLED_DIRECTORIES "${ETC};/etc")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
    "${CMAKE_BINARY_DIR}/package/conffiles;${CMAKE_BINARY_DIR}/package/postinst;${CMAKE_BINARY_DIR}/package/prerm")
include(CPack)

install(FILES README.md CHANGELOG.md DESTINATION share/doc/evit)
install(FILES LICENSE DESTINATION share/doc/evit RENAME copyright)
install(DIRECTORY docs/ DESTINATION share/doc/evit)
