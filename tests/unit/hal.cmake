# Protocol, frames and transports.
add_executable(unit_hal
  hal_crc32c.cpp
  hal_frame.cpp
  hal_frame_noise.cpp
  hal_loopback.cpp
  hal_records.cpp
  hal_structs.cpp)
target_link_libraries(unit_hal PRIVATE gridrt_hal gridrt_flags GTest::gtest_main)
gtest_discover_tests(unit_hal DISCOVERY_TIMEOUT 60)

find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
add_test(NAME unit_hal_generate
  COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/hal_generate.py)
add_test(NAME unit_hal_usb_descriptors
  COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/hal_usb_descriptors.py)

# The package for RTL has no warning and lays out records as the C++ does, where there is a linter.
find_program(GRIDRT_VERILATOR verilator)
if(GRIDRT_VERILATOR)
  add_test(NAME unit_hal_systemverilog
    COMMAND ${GRIDRT_VERILATOR} --lint-only -Wall
            ${PROJECT_BINARY_DIR}/generated/gridrt_protocol_pkg.sv
            ${PROJECT_BINARY_DIR}/generated/gridrt_usb_pkg.sv
            ${CMAKE_CURRENT_LIST_DIR}/hal_protocol_top.sv)
endif()
