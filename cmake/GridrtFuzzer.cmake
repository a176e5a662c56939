# Fuzz targets (libFuzzer): all libraries are built with coverage and with address and
# undefined-behaviour sanitizers.
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "GRIDRT_BUILD_FUZZERS needs clang: -DCMAKE_CXX_COMPILER=clang++-19")
endif()
if(NOT TARGET gridrt_fuzzing)
  add_library(gridrt_fuzzing INTERFACE)
  target_compile_options(gridrt_flags INTERFACE
    -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(gridrt_flags INTERFACE -fsanitize=address,undefined)
  target_link_options(gridrt_fuzzing INTERFACE -fsanitize=fuzzer,address,undefined)
endif()

set(GRIDRT_FUZZ_RUNS 20000 CACHE STRING "Inputs of each fuzz target's test")

# gridrt_fuzzer(NAME sources... LINK libraries... [LENGTH most bytes of an input] [SHARE n]
#               [TIMEOUT seconds of one input])
# The test fuzz.NAME runs GRIDRT_FUZZ_RUNS inputs, or one in n of them, from a fixed seed.
function(gridrt_fuzzer name)
  cmake_parse_arguments(ARG "" "LENGTH;SHARE;TIMEOUT" "LINK" ${ARGN})
  if(NOT ARG_LENGTH)
    set(ARG_LENGTH 4096)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 20)
  endif()
  if(NOT ARG_SHARE)
    set(ARG_SHARE 1)
  endif()
  math(EXPR runs "${GRIDRT_FUZZ_RUNS} / ${ARG_SHARE}")
  add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE gridrt_flags gridrt_fuzzing ${ARG_LINK})
  add_test(NAME fuzz.${name}
    COMMAND ${name} -seed=1 -runs=${runs} -max_len=${ARG_LENGTH}
            -rss_limit_mb=4096 -timeout=${ARG_TIMEOUT} -print_final_stats=1)
endfunction()
