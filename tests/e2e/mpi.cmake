# The device mpi: the contract under mpirun, and ranks that die. More ranks than cores, so that these
# tests run by themselves.
if(GRIDRT_BUILD_MPI)
  function(mpi_test name)
    add_test(NAME mpi.${name} COMMAND ${ARGN} COMMAND_EXPAND_LISTS)
    set_tests_properties(mpi.${name} PROPERTIES
      LABELS mpi TIMEOUT 600 PROCESSORS 2
      ENVIRONMENT "GRIDRT_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};PYTHONDONTWRITEBYTECODE=1")
  endfunction()
  set(mpi_run /usr/bin/python3 -B ${CMAKE_CURRENT_LIST_DIR}/mpi_contract.py)
  mpi_test(contract_1 ${mpi_run} 1)
  mpi_test(contract_3 ${mpi_run} 3)
  mpi_test(contract_8 ${mpi_run} 8 --rays 60)
  mpi_test(contract_tcp ${mpi_run} 2 --tcp)
  add_executable(mpi_stopped_sender mpi_stopped_sender.cpp)
  target_link_libraries(mpi_stopped_sender PRIVATE gridrt_mpi gridrt_flags)
  foreach(way shared_memory tcp)
    mpi_test(stopped_sender_${way} mpirun --oversubscribe --bind-to none --allow-run-as-root -n 3
             $<$<STREQUAL:${way},tcp>:--mca$<SEMICOLON>btl$<SEMICOLON>tcp,self>
             $<TARGET_FILE:mpi_stopped_sender>)
  endforeach()
  mpi_test(programs /usr/bin/python3 -B ${CMAKE_CURRENT_LIST_DIR}/mpi_test.py)
  mpi_test(failures /usr/bin/python3 -B ${CMAKE_CURRENT_LIST_DIR}/mpi_failures_test.py)
  set_tests_properties(mpi.failures PROPERTIES PROCESSORS 1)  # it waits most of the time
endif()
