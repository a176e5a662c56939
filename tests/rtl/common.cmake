# The memories that all blocks are made of.
gridrt_rtl_bench(rtl_fifo TOP gridrt_fifo PARAMETERS WIDTH=16 DEPTH=5 SOURCES fifo_bench.cpp)
gridrt_rtl_bench(rtl_fifo_one TOP gridrt_fifo PARAMETERS WIDTH=16 DEPTH=1 SOURCES fifo_bench.cpp)

# gridrt_engine_model(OUT PARAMETERS... DEFINES...): the library of the verilated engine with these, made
# where it is missing; gridrt_pace looks at the pace of each PE.
function(gridrt_engine_model out)
  cmake_parse_arguments(ARG "" "" "PARAMETERS;DEFINES" ${ARGN})
  string(MAKE_C_IDENTIFIER "rtl_engine_${ARG_PARAMETERS}_${ARG_DEFINES}" model)
  if(NOT TARGET ${model})
    gridrt_verilated(${model} TOP gridrt_engine PARAMETERS ${ARG_PARAMETERS} DEFINES ${ARG_DEFINES}
                     FILES ${PROJECT_SOURCE_DIR}/tests/rtl/gridrt_pace.sv)
    set_target_properties(${model} PROPERTIES EXCLUDE_FROM_ALL TRUE)
  endif()
  set(${out} ${model} PARENT_SCOPE)
endfunction()
