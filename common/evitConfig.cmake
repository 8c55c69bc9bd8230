# find_package(evit): evit::geometry, evit::mapping, evit::imu, evit::map, evit::events, evit::alignment, evit::evaluation, evit::overlap, evit::diagnosis,
# evit::tracking, evit::localization, evit::photometric, evit::calibration, and evit::lcmtypes, the message types' headers (<evit/NAME.hpp>); who sends them links LCM himself.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(Ceres)
find_dependency(OpenCV COMPONENTS core imgproc)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/evitTargets.cmake)
if(NOT TARGET evit::lcmtypes)
  add_library(evit::lcmtypes INTERFACE IMPORTED)
  get_filename_component(EVIT_PREFIX ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
  target_include_directories(evit::lcmtypes INTERFACE ${EVIT_PREFIX}/include)
  unset(EVIT_PREFIX)
endif()
