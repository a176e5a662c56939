# The engine in several configurations, and with random stalls inside.
function(gridrt_engine_bench name)
  gridrt_rtl_bench(rtl_engine_${name} TOP gridrt_engine SOURCES engine_bench.cpp engine_harness.cpp
                   LINK gridrt_awkward ${ARGN})
endfunction()
gridrt_engine_bench(b17_4 PARAMETERS B=17 PES=4)
gridrt_engine_bench(b12_2 PARAMETERS B=12 PES=2 TUS=1 SLOTS=16 QUEUE=4 ROB=16)
gridrt_engine_bench(stalls PARAMETERS B=17 PES=4 DEFINES GRIDRT_STALL)
