# Scenes and rays made by code, and the pieces of host/grid against the truth.
add_library(gridrt_adversarial STATIC ${CMAKE_CURRENT_LIST_DIR}/meshes.cpp
            ${CMAKE_CURRENT_LIST_DIR}/rays.cpp)
target_link_libraries(gridrt_adversarial PUBLIC gridrt_truth gridrt_grid PRIVATE gridrt_flags)

add_executable(adversarial_grid grid_pieces_test.cpp binning_test.cpp traversal_test.cpp)
target_link_libraries(adversarial_grid PRIVATE gridrt_adversarial gridrt_image gridrt_flags GTest::gtest_main)
gtest_discover_tests(adversarial_grid DISCOVERY_TIMEOUT 60
                     PROPERTIES LABELS adversarial TIMEOUT 900)
