# What they start from, for tests of other folders too.
add_library(gridrt_awkward STATIC ${CMAKE_CURRENT_LIST_DIR}/awkward.cpp)
target_link_libraries(gridrt_awkward PUBLIC gridrt_bench PRIVATE gridrt_flags GTest::gtest)

# The contract of every device, by name: a device joins by being built in.
add_executable(contract answers_test.cpp errors_test.cpp limits_test.cpp fixture.cpp)
target_link_libraries(contract PRIVATE gridrt_awkward gridrt_flags gridrt_gtest_main)
gtest_discover_tests(contract DISCOVERY_TIMEOUT 60 TEST_FILTER "-*/sim*")
gtest_discover_tests(contract DISCOVERY_TIMEOUT 60 TEST_FILTER "*/sim*"
  PROPERTIES LABELS "contract;rtl" TIMEOUT 900 ENVIRONMENT GRIDRT_CONTRACT_RAYS=300)
if(TARGET gridrt_sim)
  # Two PEs of 12 lattice bits; four of 17 whose streams pause at random, assertions on.
  foreach(board b12x2 stall)
    add_test(NAME sim.contract_${board} COMMAND contract)
    set_tests_properties(sim.contract_${board} PROPERTIES LABELS "contract;rtl" TIMEOUT 900
      ENVIRONMENT "GRIDRT_DEVICES=sim:${board};GRIDRT_CONTRACT_RAYS=100")
  endforeach()
endif()
