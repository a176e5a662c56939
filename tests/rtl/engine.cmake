# The engine in several configurations, and with random stalls inside.
function(gridrt_engine_bench name)
  gridrt_engine_model(model ${ARGN})
  gridrt_rtl_bench(rtl_engine_${name} MODEL ${model} SOURCES engine_bench.cpp engine_harness.cpp
                   LINK gridrt_awkward)
endfunction()
gridrt_engine_bench(b17_4 PARAMETERS B=17 PES=4)
gridrt_engine_bench(b12_2 PARAMETERS B=12 PES=2 TUS=1 SLOTS=16 QUEUE=4 ROB=16)
gridrt_engine_bench(stalls PARAMETERS B=17 PES=4 TUS=4 SLOTS=64 DEFINES GRIDRT_STALL GRIDRT_FREE_RUNNING)

# What cancel and feedback are for.
function(gridrt_engine_ablation name)
  gridrt_verilated(rtl_engine_ablated_${name} TOP gridrt_engine PARAMETERS B=17 PES=4 ${ARGN})
  add_executable(rtl_engine_ablation_${name} engine_ablation.cpp engine_harness.cpp)
  target_link_libraries(rtl_engine_ablation_${name} PRIVATE rtl_engine_ablated_${name}
                        gridrt_awkward gridrt_flags fmt::fmt GTest::gtest)
  target_include_directories(rtl_engine_ablation_${name} PRIVATE ${PROJECT_SOURCE_DIR})
endfunction()
add_executable(rtl_engine_ablation_none engine_ablation.cpp engine_harness.cpp)
gridrt_engine_model(model PARAMETERS B=17 PES=4)
target_link_libraries(rtl_engine_ablation_none PRIVATE ${model} gridrt_awkward gridrt_flags fmt::fmt
                      GTest::gtest)
target_include_directories(rtl_engine_ablation_none PRIVATE ${PROJECT_SOURCE_DIR})
gridrt_engine_ablation(cancel CANCEL=0)
gridrt_engine_ablation(feedback FEEDBACK=0)
add_test(NAME rtl_ablation COMMAND ${Python3_EXECUTABLE} -B
  ${CMAKE_CURRENT_LIST_DIR}/ablation_test.py $<TARGET_FILE:rtl_engine_ablation_none>
  $<TARGET_FILE:rtl_engine_ablation_cancel> $<TARGET_FILE:rtl_engine_ablation_feedback>)
