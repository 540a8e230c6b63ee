# SPDX-License-Identifier: Apache-2.0
# `cmake --install <build> --component models --prefix <folder>`: the bit-exact models with the photon model, scenes, metrics
# and calibration, for other CMake projects:
#
#   find_package(dtof REQUIRED)
#   target_link_libraries(mine PRIVATE dtof::readout)
#
# Headers are included as in this project, for instance "dtof/readout/model.hpp".
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(DTOF_MODEL_LIBRARIES core io photon sensor scene readout metrics analytic host frame pipeline container recording convert)
foreach(library ${DTOF_MODEL_LIBRARIES})
  set_target_properties(dtof_${library} PROPERTIES EXPORT_NAME ${library})
  get_target_property(internal dtof_${library} DTOF_INTERNAL_HEADERS)
  set(left_out "")
  foreach(header ${internal})
    list(APPEND left_out PATTERN ${header} EXCLUDE)
  endforeach()
  install(TARGETS dtof_${library} EXPORT dtof-models COMPONENT models ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/models/dtof/${library} COMPONENT models DESTINATION include/dtof
    FILES_MATCHING PATTERN "*.hpp" ${left_out})
endforeach()
list(TRANSFORM DTOF_MODEL_LIBRARIES PREPEND dtof_ OUTPUT_VARIABLE model_targets)
add_custom_target(dtof_models DEPENDS ${model_targets})  # what the component "models" has
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/dtof)
install(EXPORT dtof-models COMPONENT models NAMESPACE dtof:: DESTINATION ${package})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/dtof-config.cmake.in ${PROJECT_BINARY_DIR}/dtof-config.cmake
  INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dtof-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/dtof-config.cmake ${PROJECT_BINARY_DIR}/dtof-config-version.cmake COMPONENT models
  DESTINATION ${package})
