# Software PEs and the driver: isolation of PEs, recovery from a bad link, refusals.
add_executable(unit_pe pe_isolation_test.cpp pe_engine_test.cpp pe_races_test.cpp
               pe_schedules_test.cpp pe_stream_test.cpp grid_segments_test.cpp)
target_link_libraries(unit_pe PRIVATE gridrt_adversarial gridrt_driver gridrt_pe gridrt_image gridrt_scene
                      gridrt_flags GTest::gtest_main fmt::fmt)
gtest_discover_tests(unit_pe DISCOVERY_TIMEOUT 60)

add_executable(unit_driver driver_endless_test.cpp driver_ray_order_test.cpp driver_recovery_test.cpp driver_refusal_test.cpp)
target_link_libraries(unit_driver PRIVATE gridrt_driver gridrt_pe gridrt_image gridrt_scene
                      gridrt_flags GTest::gtest_main fmt::fmt)
gtest_discover_tests(unit_driver DISCOVERY_TIMEOUT 60)
