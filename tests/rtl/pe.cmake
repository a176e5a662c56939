# The processing element: its exact test and division against wide integers.
foreach(bits 12 14 17)
  gridrt_rtl_bench(rtl_triangle_${bits} TOP gridrt_triangle PARAMETERS B=${bits} META=32
                   SOURCES triangle_bench.cpp)
  gridrt_rtl_bench(rtl_quotient_${bits} TOP gridrt_quotient PARAMETERS B=${bits}
                   SOURCES quotient_bench.cpp)
endforeach()
# The test as it is on an ECP5: of its multipliers and adders.
set(dsp ${CMAKE_CURRENT_BINARY_DIR}/ecp5)
add_custom_command(OUTPUT ${dsp}/MULT18X18D.sv ${dsp}/ALU54B.sv
  COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/ecp5/make_dsp.py ${dsp}
  DEPENDS ${CMAKE_CURRENT_LIST_DIR}/ecp5/make_dsp.py VERBATIM)
add_custom_command(OUTPUT ${dsp}/gridrt_ecp5_slice.sv
  COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/rtl/pe/make_ecp5_slice.py ${dsp}/gridrt_ecp5_slice.sv
  DEPENDS ${PROJECT_SOURCE_DIR}/rtl/pe/make_ecp5_slice.py VERBATIM)
gridrt_rtl_bench(rtl_triangle_ecp5 TOP gridrt_triangle PARAMETERS B=17 META=32 DEFINES GRIDRT_ECP5 GRIDRT_FREE_RUNNING
                 FILES ${dsp}/MULT18X18D.sv ${dsp}/ALU54B.sv ${dsp}/gridrt_ecp5_slice.sv
                 SOURCES triangle_bench.cpp)
gridrt_rtl_bench(rtl_resolve_17 TOP gridrt_resolve PARAMETERS B=17 TRIS=64 SLOTS=64 DIVIDERS=3
                 SOURCES resolve_bench.cpp)
gridrt_rtl_bench(rtl_resolve_14 TOP gridrt_resolve PARAMETERS B=14 TRIS=200 SLOTS=5 DIVIDERS=2
                 SOURCES resolve_bench.cpp)
gridrt_rtl_bench(rtl_resolve_12 TOP gridrt_resolve PARAMETERS B=12 TRIS=16 SLOTS=1 DIVIDERS=1
                 SOURCES resolve_bench.cpp)

# The whole of it: as on the board, small, without cancelling, and with pauses inside.
set(board B=17 SLOTS=64 REFS=8192 TRIS=4096 VERTS=2560 DIVIDERS=2 NUMBER=0)
set(small B=12 SLOTS=8 REFS=300 TRIS=100 VERTS=64 DIVIDERS=1 NUMBER=2)
gridrt_rtl_bench(rtl_pe_17 TOP gridrt_pe PARAMETERS ${board} SOURCES pe_bench.cpp LINK gridrt_hal gridrt_image)
gridrt_rtl_bench(rtl_pe_12 TOP gridrt_pe PARAMETERS ${small} SOURCES pe_bench.cpp LINK gridrt_hal gridrt_image)
gridrt_rtl_bench(rtl_pe_stalls TOP gridrt_pe PARAMETERS ${board} DEFINES GRIDRT_STALL GRIDRT_FREE_RUNNING
                 SOURCES pe_bench.cpp LINK gridrt_hal gridrt_image)
target_compile_definitions(rtl_pe_stalls PRIVATE GRIDRT_STALL)
gridrt_rtl_bench(rtl_pe_no_cancel TOP gridrt_pe PARAMETERS ${small} "CANCEL=1'b0"
                 SOURCES pe_bench.cpp LINK gridrt_hal gridrt_image)
target_compile_definitions(rtl_pe_no_cancel PRIVATE GRIDRT_BENCH_NO_CANCEL)
