# Ranks without MPI: as threads, with messages that get lost.
if(GRIDRT_BUILD_MPI)
  add_executable(unit_mpi mpi_ranks_test.cpp)
  target_link_libraries(unit_mpi PRIVATE gridrt_mpi gridrt_driver gridrt_pe gridrt_image gridrt_scene
                        gridrt_flags GTest::gtest_main fmt::fmt)
  gtest_discover_tests(unit_mpi DISCOVERY_TIMEOUT 60)
endif()
