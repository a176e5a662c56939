# Memory images and .grt files.
add_executable(unit_image
  image_blocks.cpp
  image_build.cpp
  image_file.cpp
  image_limits.cpp
  image_measured.cpp
  image_quarters.cpp
  image_scene.cpp
  image_verify.cpp
  image_weld.cpp)
target_link_libraries(unit_image PRIVATE gridrt_image gridrt_scene gridrt_flags GTest::gtest_main)
gtest_discover_tests(unit_image DISCOVERY_TIMEOUT 60)
