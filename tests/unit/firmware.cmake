# The firmware's logic, around software PEs.
add_executable(unit_firmware firmware_boot_test.cpp firmware_reports_test.cpp
  firmware_watch_test.cpp)
target_link_libraries(unit_firmware PRIVATE gridrt_board_model gridrt_firmware_vectors_b17x4
  gridrt_driver gridrt_pe gridrt_image gridrt_scene gridrt_hal gridrt_flags GTest::gtest_main)
gtest_discover_tests(unit_firmware DISCOVERY_TIMEOUT 60)
