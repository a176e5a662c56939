# Finds libusb 1.0: target LibUSB::usb.
find_path(LIBUSB_INCLUDE_DIR libusb.h PATH_SUFFIXES libusb-1.0)
find_library(LIBUSB_LIBRARY usb-1.0)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LibUSB REQUIRED_VARS LIBUSB_LIBRARY LIBUSB_INCLUDE_DIR)
if(LibUSB_FOUND AND NOT TARGET LibUSB::usb)
  add_library(LibUSB::usb UNKNOWN IMPORTED)
  set_target_properties(LibUSB::usb PROPERTIES IMPORTED_LOCATION ${LIBUSB_LIBRARY}
                        INTERFACE_INCLUDE_DIRECTORIES ${LIBUSB_INCLUDE_DIR})
endif()
mark_as_advanced(LIBUSB_INCLUDE_DIR LIBUSB_LIBRARY)
