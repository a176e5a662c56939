# The house rules as tests: scripts, arrows, formatting, analysis, package.
function(house_test name)
  add_test(NAME house.${name} COMMAND ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(house.${name} PROPERTIES LABELS house TIMEOUT 120)
endfunction()

find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
set(python ${Python3_EXECUTABLE})
house_test(arrows ${python} tools/arrows)
house_test(arrows_refuses ${python} tests/e2e/arrows_test.py)
house_test(setup ${python} tests/e2e/setup_test.py)
house_test(format tools/lint format)
