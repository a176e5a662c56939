# The house rules as tests: scripts, arrows, formatting, analysis, package.
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)

function(house_test name)
  add_test(NAME house.${name} COMMAND ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(house.${name} PROPERTIES LABELS house TIMEOUT 900)
endfunction()

house_test(arrows ${Python3_EXECUTABLE} tools/arrows)
house_test(arrows_refuses ${Python3_EXECUTABLE} tests/e2e/arrows_test.py)
house_test(setup ${Python3_EXECUTABLE} tests/e2e/setup_test.py)
house_test(package ${Python3_EXECUTABLE} tests/e2e/package_test.py
           ${PROJECT_BINARY_DIR} ${CMAKE_CXX_COMPILER})

# The rest speaks of the tools and the build tree that tools/test has prepared.
if(PROJECT_BINARY_DIR STREQUAL "${PROJECT_SOURCE_DIR}/build")
  house_test(demo ${Python3_EXECUTABLE} tests/e2e/demo_test.py)
  set_tests_properties(house.demo PROPERTIES RUN_SERIAL ON)  # it may link the programs again
  # Unit tests and short runs of the fuzzers under sanitizers (cmake --build --preset fuzz).
  add_test(NAME sanitized COMMAND
    ${CMAKE_CTEST_COMMAND} --test-dir ${PROJECT_SOURCE_DIR}/build-fuzz --no-tests=error
    --output-on-failure --parallel 2 --label-regex "^(unit|fuzz)$" --exclude-regex "^audit$|PrunedEqualsBruteForce")
  set_tests_properties(sanitized PROPERTIES LABELS sanitized TIMEOUT 1800 PROCESSORS 2)
endif()
house_test(format ${Python3_EXECUTABLE} tools/lint format)
house_test(tidy ${Python3_EXECUTABLE} tools/lint --fast
           --since docs/results/lint.txt --build ${PROJECT_BINARY_DIR} tidy)
set_tests_properties(house.tidy PROPERTIES LABELS "house;slow" TIMEOUT 1500 PROCESSORS 2)
