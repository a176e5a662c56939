# The cases, each device answer against the truth.
find_package(fmt REQUIRED)
add_library(gridrt_bench STATIC ${CMAKE_CURRENT_LIST_DIR}/bench.cpp
                                ${CMAKE_CURRENT_LIST_DIR}/devices.cpp)
target_link_libraries(gridrt_bench PUBLIC gridrt_adversarial gridrt_driver
                      PRIVATE gridrt_flags fmt::fmt)

# sim_cases(NAME PROGRAM DEVICES): the program once more on simulated boards, with a part of the rays.
function(sim_cases name program devices)
  if(TARGET gridrt_sim)
    add_test(NAME sim.${name} COMMAND ${program})
    set_tests_properties(sim.${name} PROPERTIES LABELS "adversarial;rtl" TIMEOUT 900
      ENVIRONMENT "GRIDRT_DEVICES=${devices};GRIDRT_FRACTION=1/64")
  endif()
endfunction()

# gridrt_cases(NAME sources...): one program of cases; on the simulated boards it runs once more,
# with a part of the rays (all of them: GRIDRT_DEVICES=sim build/bin/adversarial_NAME).
function(gridrt_cases name)
  add_executable(adversarial_${name} ${ARGN})
  target_link_libraries(adversarial_${name} PRIVATE gridrt_bench gridrt_flags gridrt_gtest_main)
  gtest_discover_tests(adversarial_${name} DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS adversarial TIMEOUT 900)
  sim_cases(${name} adversarial_${name} sim,sim:stall)
endfunction()

gridrt_cases(sheets sheets_test.cpp)
gridrt_cases(aimed aimed_test.cpp)
gridrt_cases(scaling scaling_test.cpp)
gridrt_cases(degenerate degenerate_test.cpp)
gridrt_cases(directions directions_test.cpp)
gridrt_cases(uneven uneven_test.cpp)
target_link_libraries(adversarial_uneven PRIVATE gridrt_scene)
target_compile_definitions(adversarial_uneven
  PRIVATE GRIDRT_SCENES="${PROJECT_SOURCE_DIR}/../shared/scenes")
gridrt_cases(secondary secondary_test.cpp walk.cpp)
gridrt_cases(chunks chunks_test.cpp)
target_link_libraries(adversarial_chunks PRIVATE gridrt_pe gridrt_image)
gridrt_cases(skip skip_test.cpp)
target_link_libraries(adversarial_skip PRIVATE gridrt_pe gridrt_image)

# Those that do not rely on 17 lattice bits, on two PEs of 12.
foreach(name aimed scaling degenerate directions)
  sim_cases(${name}_b12x2 adversarial_${name} sim:b12x2)
endforeach()

# The long run (tools/truth-run), and a short one so that it never rots.
find_package(CLI11 REQUIRED)
find_package(Threads REQUIRED)
add_executable(truth-run truth_run.cpp walk.cpp)
target_link_libraries(truth-run PRIVATE gridrt_bench gridrt_scene gridrt_flags fmt::fmt
                      CLI11::CLI11 Threads::Threads)
add_test(NAME truth_run_short COMMAND truth-run --rays 200000)
set_tests_properties(truth_run_short PROPERTIES LABELS adversarial TIMEOUT 900)
