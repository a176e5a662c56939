# The CMake package: programs, libraries, headers, and a GridRTConfig.cmake that finds what the
# static libraries were linked with. A program that uses it is in examples/trace.
include(CMakePackageConfigHelpers)

# What host/gridrt.hpp needs, under one name.
add_library(gridrt INTERFACE)
add_library(GridRT::gridrt ALIAS gridrt)
target_link_libraries(gridrt INTERFACE gridrt_driver gridrt_image gridrt_grid gridrt_scene)

# All libraries but the inside of the programs.
get_property(libraries GLOBAL PROPERTY GRIDRT_LIBRARIES)
list(REMOVE_ITEM libraries gridrt_app)
install(TARGETS ${libraries} gridrt EXPORT GridRTTargets)
install(EXPORT GridRTTargets NAMESPACE GridRT::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/GridRT)
install(TARGETS gridrt-host gridrt-image gridrt-board)
if(GRIDRT_BUILD_MPI)
  install(TARGETS gridrt-rank)
endif()

install(DIRECTORY hal host DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridrt
        FILES_MATCHING PATTERN "*.hpp" PATTERN "app" EXCLUDE)
install(DIRECTORY ${PROJECT_BINARY_DIR}/generated/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridrt
        FILES_MATCHING PATTERN "*.hpp")
install(FILES host/gridrt.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gridrt)

# The namespace of an imported target is the name of the package that defines it, for every
# library the project uses.
set(GRIDRT_DEPENDENCIES)
foreach(library IN LISTS libraries)
  get_target_property(linked ${library} LINK_LIBRARIES)
  string(REGEX MATCHALL "[A-Za-z0-9_]+::" namespaces "${linked}")
  list(APPEND GRIDRT_DEPENDENCIES ${namespaces})
endforeach()
list(TRANSFORM GRIDRT_DEPENDENCIES REPLACE "::" "")
list(REMOVE_DUPLICATES GRIDRT_DEPENDENCIES)
list(REMOVE_ITEM GRIDRT_DEPENDENCIES GridRT)
list(JOIN GRIDRT_DEPENDENCIES " " GRIDRT_DEPENDENCIES)

configure_package_config_file(
  cmake/GridRTConfig.cmake.in ${PROJECT_BINARY_DIR}/GridRTConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/GridRT)
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/GridRTConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/GridRTConfig.cmake
              ${PROJECT_BINARY_DIR}/GridRTConfigVersion.cmake cmake/FindGMP.cmake cmake/FindHighway.cmake
              cmake/FindHIDAPI.cmake cmake/FindLibUSB.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/GridRT)
if(GRIDRT_BUILD_USB)
  install(FILES ${PROJECT_BINARY_DIR}/generated/70-gridrt.rules DESTINATION lib/udev/rules.d)
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
