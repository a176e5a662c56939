# Finds the parser of the USB redirection protocol: target UsbRedir::parser.
find_path(USBREDIR_INCLUDE_DIR usbredirparser.h)
find_library(USBREDIR_LIBRARY usbredirparser)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(UsbRedir REQUIRED_VARS USBREDIR_LIBRARY USBREDIR_INCLUDE_DIR)
if(UsbRedir_FOUND AND NOT TARGET UsbRedir::parser)
  add_library(UsbRedir::parser UNKNOWN IMPORTED)
  set_target_properties(UsbRedir::parser PROPERTIES IMPORTED_LOCATION ${USBREDIR_LIBRARY}
                        INTERFACE_INCLUDE_DIRECTORIES ${USBREDIR_INCLUDE_DIR})
endif()
mark_as_advanced(USBREDIR_INCLUDE_DIR USBREDIR_LIBRARY)
