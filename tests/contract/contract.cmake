# The contract of every device, by name: a device joins by being built in.
add_executable(contract answers_test.cpp errors_test.cpp limits_test.cpp fixture.cpp)
target_link_libraries(contract PRIVATE gridrt_bench gridrt_flags GTest::gtest_main)
gtest_discover_tests(contract DISCOVERY_TIMEOUT 60)
