# The renderer, against brute force and hand-worked results.
find_package(PNG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
add_executable(unit_render render_camera_test.cpp render_files_test.cpp render_optics_test.cpp
  render_shading_test.cpp render_waves_test.cpp)
target_link_libraries(unit_render PRIVATE
  gridrt_render gridrt_flags PNG::PNG OpenEXR::OpenEXR GTest::gtest_main)
gtest_discover_tests(unit_render DISCOVERY_TIMEOUT 60)
