# What the programs are made of: options and files.
add_executable(unit_app app_npy_test.cpp app_options_test.cpp)
target_link_libraries(unit_app PRIVATE gridrt_app gridrt_flags GTest::gtest_main)
gtest_discover_tests(unit_app DISCOVERY_TIMEOUT 60)
