# Finds hidapi's hidraw backend: target HIDAPI::hidraw.
find_path(HIDAPI_INCLUDE_DIR hidapi.h PATH_SUFFIXES hidapi)
find_library(HIDAPI_LIBRARY hidapi-hidraw)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(HIDAPI REQUIRED_VARS HIDAPI_LIBRARY HIDAPI_INCLUDE_DIR)
if(HIDAPI_FOUND AND NOT TARGET HIDAPI::hidraw)
  add_library(HIDAPI::hidraw UNKNOWN IMPORTED)
  set_target_properties(HIDAPI::hidraw PROPERTIES IMPORTED_LOCATION ${HIDAPI_LIBRARY}
                        INTERFACE_INCLUDE_DIRECTORIES ${HIDAPI_INCLUDE_DIR})
endif()
mark_as_advanced(HIDAPI_INCLUDE_DIR HIDAPI_LIBRARY)
