# The link to a board on USB, its own code over stand-ins for libusb and hidapi, and what the virtual
# board's servers say.
if(GRIDRT_BUILD_USB AND TARGET gridrt_virtual)
  set(usb ${PROJECT_SOURCE_DIR}/hal/usb)
  add_library(gridrt_fake_usb OBJECT usb_fake_bus.cpp usb_fake_faults.cpp usb_fake_hid.cpp
    ${usb}/bulk_link.cpp ${usb}/hid_link.cpp ${usb}/messages.cpp ${usb}/usb_transport.cpp)
  target_include_directories(gridrt_fake_usb SYSTEM PUBLIC
    $<TARGET_PROPERTY:LibUSB::usb,INTERFACE_INCLUDE_DIRECTORIES>
    $<TARGET_PROPERTY:HIDAPI::hidraw,INTERFACE_INCLUDE_DIRECTORIES>)
  target_link_libraries(gridrt_fake_usb PUBLIC gridrt_virtual gridrt_hal PRIVATE gridrt_flags)

  add_executable(unit_usb usb_faults_test.cpp usb_flash_test.cpp usb_function_test.cpp usb_link_test.cpp
    usb_usbip_test.cpp)
  target_link_libraries(unit_usb PRIVATE gridrt_fake_usb gridrt_awkward gridrt_virtual gridrt_driver
    gridrt_pe gridrt_image gridrt_scene gridrt_hal gridrt_flags GTest::gtest_main)
  target_compile_definitions(unit_usb PRIVATE GRIDRT_SOURCE="${PROJECT_SOURCE_DIR}")
  gtest_discover_tests(unit_usb DISCOVERY_TIMEOUT 60)

  if(TARGET gridrt_sim)
    add_executable(unit_usb_simulated usb_simulated_test.cpp)
    target_link_libraries(unit_usb_simulated PRIVATE gridrt_fake_usb gridrt_awkward gridrt_virtual
      gridrt_driver gridrt_image gridrt_hal gridrt_flags GTest::gtest_main)
    gtest_discover_tests(unit_usb_simulated DISCOVERY_TIMEOUT 60)
  endif()
endif()
