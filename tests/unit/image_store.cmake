# What a device makes of damaged sections.
add_executable(unit_image_store image_store_test.cpp)
target_link_libraries(unit_image_store PRIVATE gridrt_pe gridrt_image gridrt_adversarial
                      gridrt_flags GTest::gtest_main)
gtest_discover_tests(unit_image_store DISCOVERY_TIMEOUT 60 PROPERTIES LABELS unit)
