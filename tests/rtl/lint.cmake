# No module of rtl/ has a warning, taken as a design of its own.
add_test(NAME rtl_lint COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/lint_test.py
  --verilator ${GRIDRT_VERILATOR} --protocol ${PROJECT_BINARY_DIR}/generated/gridrt_protocol_pkg.sv
  --protocol ${PROJECT_BINARY_DIR}/generated/gridrt_usb_pkg.sv
  --library ${GRIDRT_PICORV32_FOLDER} --library ${GRIDRT_LUNA_FOLDER}
  --library ${CMAKE_CURRENT_LIST_DIR}/ecp5 ${PROJECT_SOURCE_DIR}/rtl)
# Illegal parameters are refused.
add_test(NAME rtl_parameters COMMAND ${Python3_EXECUTABLE} -B
  ${CMAKE_CURRENT_LIST_DIR}/parameters_test.py --verilator ${GRIDRT_VERILATOR}
  --protocol ${PROJECT_BINARY_DIR}/generated/gridrt_protocol_pkg.sv ${PROJECT_SOURCE_DIR}/rtl)
# How the delays of a routed design are read.
add_test(NAME rtl_pin_timing COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/pin_timing_test.py)
