# Simulation of RTL: Verilator makes a C++ class of a module, once for each choice of parameters.
#
# gridrt_verilated(NAME TOP module [PREFIX class] [PARAMETERS B=17 ...] [DEFINES MACRO ...]
#                  [FILES file.sv ...] [FIRMWARE board] [LUNA] [TRACE] [FAST])
#   Static library NAME with the class V<module>, or that of PREFIX (#include <Vmodule.h>). Modules
#   below rtl/ are found by name and packages are read always; FILES names what lies elsewhere. Each
#   parameter is a macro for users of the library, too: GRIDRT_RTL_B=17. GRIDRT_ASSERT is defined,
#   so that the assertions of the RTL are checked. Warnings are errors. TRACE: waves as FST.
#   FIRMWARE: that board's image (firmware/soft_core) is in the soft core's memory.
#   LUNA: with the USB device (cmake/GridrtLuna.cmake).
#   FAST: as fast as it gets, without assertions, registers without reset start as zeros.
#
# gridrt_rtl_bench(NAME TOP module SOURCES bench.cpp ... [LINK library ...] [and all of the above])
#   GoogleTest executable NAME on that model, its tests known to ctest with the label "rtl".
#   Benches with the same module, parameters, macros and files share one library. With MODEL library
#   in place of TOP and what follows it, that one is used.
find_program(GRIDRT_VERILATOR verilator)
if(NOT GRIDRT_VERILATOR)
  message(FATAL_ERROR "Verilator is missing, which GRIDRT_BUILD_SIM=ON needs: run \"tools/setup\" "
    "(on Debian 12), install Verilator 5.006 or later, or configure with -DGRIDRT_BUILD_SIM=OFF.")
endif()
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
find_package(Threads REQUIRED)
find_package(ZLIB REQUIRED)
include(GridrtPicorv32)
if(GRIDRT_BUILD_TESTS)
  include(GridrtLuna)
endif()

execute_process(COMMAND ${GRIDRT_VERILATOR} --getenv VERILATOR_ROOT
  OUTPUT_VARIABLE GRIDRT_VERILATOR_ROOT OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(GRIDRT_VERILATOR_INCLUDE ${GRIDRT_VERILATOR_ROOT}/include)

# Folders with modules, and packages: gridrt_pkg first, others may use it.
file(GLOB_RECURSE rtl_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/rtl/*.sv)
set(GRIDRT_RTL_FOLDERS ${rtl_files})
list(TRANSFORM GRIDRT_RTL_FOLDERS REPLACE "/[^/]*$" "")
list(REMOVE_DUPLICATES GRIDRT_RTL_FOLDERS)
set(GRIDRT_RTL_PACKAGES ${rtl_files})
list(FILTER GRIDRT_RTL_PACKAGES INCLUDE REGEX "_pkg\\.sv$")
list(REMOVE_ITEM GRIDRT_RTL_PACKAGES ${PROJECT_SOURCE_DIR}/rtl/gridrt_pkg.sv)
set(GRIDRT_RTL_PACKAGES
  ${PROJECT_BINARY_DIR}/generated/gridrt_protocol_pkg.sv
  ${PROJECT_BINARY_DIR}/generated/gridrt_usb_pkg.sv
  ${PROJECT_SOURCE_DIR}/rtl/gridrt_pkg.sv
  ${GRIDRT_RTL_PACKAGES})
set(GRIDRT_RTL_MODULES ${rtl_files})
list(FILTER GRIDRT_RTL_MODULES EXCLUDE REGEX "_pkg\\.sv$")

# Two warnings are of no use in assertions: that they look at the reset at clock edges, and that
# the width of a signal already proves a bound. Without assertions they are on: tests/rtl/lint.
set(GRIDRT_ASSERT_WARNINGS -Wno-SYNCASYNCNET -Wno-CMPCONST)

# What every model needs at run time; not our code, so our warnings are off.
add_library(gridrt_verilator STATIC
  ${GRIDRT_VERILATOR_INCLUDE}/verilated.cpp
  ${GRIDRT_VERILATOR_INCLUDE}/verilated_threads.cpp
  ${GRIDRT_VERILATOR_INCLUDE}/verilated_fst_c.cpp)
target_include_directories(gridrt_verilator SYSTEM PUBLIC
  ${GRIDRT_VERILATOR_INCLUDE} ${GRIDRT_VERILATOR_INCLUDE}/vltstd)
target_compile_options(gridrt_verilator PRIVATE -w -O2)
target_link_libraries(gridrt_verilator PUBLIC Threads::Threads ZLIB::ZLIB)

function(gridrt_verilated name)
  cmake_parse_arguments(ARG "TRACE;FAST;LUNA" "TOP;PREFIX;FIRMWARE" "PARAMETERS;DEFINES;FILES" ${ARGN})
  set(prefix V${ARG_TOP})
  if(ARG_PREFIX)
    set(prefix ${ARG_PREFIX})
  endif()
  set(folder ${CMAKE_CURRENT_BINARY_DIR}/${name})
  set(flags --top-module ${ARG_TOP} -Wall -O3 --no-timing)
  if(ARG_FAST)
    list(APPEND flags --x-assign fast --x-initial fast)
  else()
    list(APPEND flags --assert -DGRIDRT_ASSERT ${GRIDRT_ASSERT_WARNINGS})
  endif()
  foreach(define IN LISTS ARG_DEFINES)
    list(APPEND flags -D${define})
  endforeach()
  foreach(parameter IN LISTS ARG_PARAMETERS)
    list(APPEND flags -G${parameter})
  endforeach()
  if(ARG_TRACE)
    list(APPEND flags --trace-fst --trace-structs)
  endif()
  if(ARG_FIRMWARE)
    list(APPEND flags -DGRIDRT_FIRMWARE
      -I${PROJECT_BINARY_DIR}/firmware/soft_core/${ARG_FIRMWARE})
  endif()
  list(APPEND flags -y ${GRIDRT_PICORV32_FOLDER} ${PROJECT_SOURCE_DIR}/rtl/soc/picorv32.vlt)
  if(ARG_LUNA)
    list(APPEND flags -y ${GRIDRT_LUNA_FOLDER} ${PROJECT_SOURCE_DIR}/rtl/usb/luna.vlt)
  endif()
  foreach(search IN LISTS GRIDRT_RTL_FOLDERS)
    list(APPEND flags -y ${search})
  endforeach()
  foreach(file IN LISTS ARG_FILES)
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR})
    list(APPEND files ${file})
  endforeach()
  set(top ${GRIDRT_RTL_MODULES})
  list(FILTER top INCLUDE REGEX "/${ARG_TOP}\\.sv$")
  add_custom_command(
    OUTPUT ${folder}/${prefix}__fast.cpp ${folder}/${prefix}__slow.cpp
    COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/cmake/verilate.py
            --verilator ${GRIDRT_VERILATOR} --prefix ${prefix} --folder ${folder}
            --depfile ${folder}/${prefix}.d -- ${flags} ${GRIDRT_RTL_PACKAGES} ${files} ${top}
    DEPENDS ${PROJECT_SOURCE_DIR}/cmake/verilate.py ${GRIDRT_RTL_PACKAGES} ${files} ${top}
    DEPFILE ${folder}/${prefix}.d
    COMMENT "Verilating ${name}"
    VERBATIM)
  add_library(${name} STATIC ${folder}/${prefix}__fast.cpp ${folder}/${prefix}__slow.cpp)
  set_source_files_properties(${folder}/${prefix}__slow.cpp PROPERTIES COMPILE_OPTIONS -O0)
  target_include_directories(${name} SYSTEM PUBLIC ${folder}/model)
  # -O2 takes more than twice as long to compile, and -O3 makes a model 3 % faster.
  target_compile_options(${name} PRIVATE -w -O1)
  list(TRANSFORM ARG_PARAMETERS PREPEND GRIDRT_RTL_)
  target_compile_definitions(${name} PUBLIC ${ARG_PARAMETERS})
  target_link_libraries(${name} PUBLIC gridrt_verilator)
  add_dependencies(${name} gridrt_protocol)
  if(ARG_FIRMWARE)
    add_dependencies(${name} gridrt_firmware_image_${ARG_FIRMWARE})
  endif()
  if(ARG_LUNA)
    add_dependencies(${name} gridrt_luna)
  endif()
endfunction()

function(gridrt_rtl_bench name)
  cmake_parse_arguments(ARG "TRACE;LUNA" "TOP;MODEL" "SOURCES;LINK;PARAMETERS;DEFINES;FILES;FIRMWARE" ${ARGN})
  set(model TOP ${ARG_TOP})
  foreach(word PARAMETERS DEFINES FILES FIRMWARE)
    if(ARG_${word})
      list(APPEND model ${word} ${ARG_${word}})
    endif()
  endforeach()
  foreach(word TRACE LUNA)
    if(ARG_${word})
      list(APPEND model ${word})
    endif()
  endforeach()
  string(MAKE_C_IDENTIFIER "rtl_${ARG_TOP}_${ARG_PARAMETERS}" library)
  if(ARG_DEFINES OR ARG_FILES OR ARG_FIRMWARE OR ARG_TRACE OR ARG_LUNA)
    string(SHA256 hash "${model}")
    string(SUBSTRING ${hash} 0 8 hash)
    string(APPEND library _${hash})
  endif()
  if(ARG_MODEL)
    set(library ${ARG_MODEL})
  elseif(NOT TARGET ${library})
    gridrt_verilated(${library} ${model})
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${library} ${ARG_LINK} gridrt_flags GTest::gtest_main)
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR})
  gtest_discover_tests(${name} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 PROPERTIES LABELS rtl)
endfunction()
