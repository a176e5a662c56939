# The march: its model against exact truth, setup and traversal against the model.
add_executable(rtl_march march_test.cpp)
target_link_libraries(rtl_march PRIVATE gridrt_image gridrt_flags GTest::gtest_main)
gtest_discover_tests(rtl_march DISCOVERY_TIMEOUT 60 PROPERTIES LABELS rtl TIMEOUT 300)

gridrt_rtl_bench(rtl_ray_cells TOP gridrt_ray_cells SOURCES ray_cells_bench.cpp)
gridrt_rtl_bench(rtl_quarters TOP gridrt_quarters SOURCES quarters_bench.cpp LINK gridrt_image)
gridrt_rtl_bench(rtl_match TOP gridrt_match SOURCES match_bench.cpp LINK gridrt_image)
gridrt_rtl_bench(rtl_tap TOP gridrt_tap PARAMETERS EXPS=2 PES=4 SOURCES tap_bench.cpp
                 LINK gridrt_grid)
gridrt_rtl_bench(rtl_grid_config TOP gridrt_grid_config SOURCES grid_config_bench.cpp
                 LINK gridrt_grid)
foreach(bits 12 14 17)
  gridrt_rtl_bench(rtl_setup_${bits} TOP gridrt_setup PARAMETERS B=${bits} SOURCES setup_bench.cpp
                   LINK gridrt_grid)
endforeach()
gridrt_rtl_bench(rtl_traverse TOP gridrt_traverse PARAMETERS B=17 SOURCES traverse_bench.cpp
                 LINK gridrt_image)
