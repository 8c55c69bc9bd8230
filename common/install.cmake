# The algorithms as a CMake package: find_package(evit) gives evit::tracking and the others below, without LCM or protobuf.
# Headers are included as in the sources: "common/tracking/tracker.h".
include(CMakePackageConfigHelpers)

set(EVIT_ALGORITHMS files parallel geometry imu map events alignment evaluation overlap diagnosis tracking localization photometric mapping calibration)
foreach(NAME ${EVIT_ALGORITHMS})
  set_target_properties(evit_${NAME} PROPERTIES EXPORT_NAME ${NAME})
  install(TARGETS evit_${NAME} EXPORT evit ARCHIVE DESTINATION lib)
endforeach()
foreach(FOLDER time simd text ${EVIT_ALGORITHMS})
  install(DIRECTORY ${FOLDER} DESTINATION include/evit/common FILES_MATCHING PATTERN "*.h"
          PATTERN "test_*" EXCLUDE PATTERN wire EXCLUDE)
endforeach()

set(PACKAGE_DIR lib/cmake/evit)
install(EXPORT evit NAMESPACE evit:: FILE evitTargets.cmake DESTINATION ${PACKAGE_DIR})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/evitConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES evitConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/evitConfigVersion.cmake DESTINATION ${PACKAGE_DIR})
