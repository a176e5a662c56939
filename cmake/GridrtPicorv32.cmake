# Finds the soft core's Verilog, which tools/setup installs from PyPI: GRIDRT_PICORV32 is the file.
if(DEFINED ENV{GRIDRT_HARDWARE_VENV})
  set(places $ENV{GRIDRT_HARDWARE_VENV})
endif()
list(APPEND places ${PROJECT_SOURCE_DIR}/build/hardware ${PROJECT_BINARY_DIR}/hardware)
list(TRANSFORM places APPEND
  /lib/python3*/site-packages/pythondata_cpu_picorv32/verilog/picorv32.v)
file(GLOB found ${places})
list(APPEND found "")
list(GET found 0 found)
set(GRIDRT_PICORV32 "${found}" CACHE FILEPATH "picorv32.v")
if(NOT GRIDRT_PICORV32 OR NOT EXISTS ${GRIDRT_PICORV32})
  unset(GRIDRT_PICORV32 CACHE)
  message(FATAL_ERROR "picorv32.v is missing, which GRIDRT_BUILD_SIM=ON needs: run \"tools/setup\" "
    "(on Debian 12), or install pythondata-cpu-picorv32 from PyPI and configure with "
    "-DGRIDRT_PICORV32=.../picorv32.v, or with -DGRIDRT_BUILD_SIM=OFF.")
endif()
cmake_path(GET GRIDRT_PICORV32 PARENT_PATH GRIDRT_PICORV32_FOLDER)
