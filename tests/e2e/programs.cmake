# The programs from outside: command lines, files, exit codes.
set(programs pictures rays failures chunks)
if(TARGET gridrt_sim)
  list(APPEND programs sim)
endif()
foreach(name IN LISTS programs)
  add_test(NAME e2e.${name} COMMAND /usr/bin/python3 -B ${CMAKE_CURRENT_LIST_DIR}/${name}_test.py)
  set_tests_properties(e2e.${name} PROPERTIES
    LABELS e2e TIMEOUT 600
    ENVIRONMENT "GRIDRT_BIN=${CMAKE_RUNTIME_OUTPUT_DIRECTORY};PYTHONDONTWRITEBYTECODE=1")
endforeach()
