# The truth itself: against hand-worked answers, a second formula, and unpruned search.
add_executable(unit_truth truth_volumes_test.cpp truth_lattice_test.cpp truth_tracer_test.cpp
               truth_given_test.cpp)
target_link_libraries(unit_truth PRIVATE gridrt_adversarial gridrt_truth gridrt_flags GTest::gtest_main)
gtest_discover_tests(unit_truth DISCOVERY_TIMEOUT 60)

# Debian's interpreter, for Debian's numpy.
add_test(NAME audit COMMAND /usr/bin/python3 ${CMAKE_CURRENT_LIST_DIR}/audit_test.py)
