# Scenes: numbers, every format, built-in scenes.
find_package(fmt REQUIRED)
add_executable(unit_scene
  scene_builtin_test.cpp
  scene_check_test.cpp
  scene_files_test.cpp
  scene_formats_test.cpp
  scene_gltf_test.cpp
  scene_mtl_test.cpp
  scene_number_test.cpp
  scene_obj_test.cpp
  scene_ply_test.cpp
  scene_stl_test.cpp
  scene_support.cpp
  scene_toml_test.cpp
  scene_writers.cpp)
target_link_libraries(unit_scene PRIVATE gridrt_scene gridrt_flags GTest::gtest_main fmt::fmt)
target_compile_definitions(unit_scene PRIVATE
  GRIDRT_SHARED_SCENES="${PROJECT_SOURCE_DIR}/../shared/scenes")
gtest_discover_tests(unit_scene DISCOVERY_TIMEOUT 60)
