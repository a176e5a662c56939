# The memories that all blocks are made of.
gridrt_rtl_bench(rtl_fifo TOP gridrt_fifo PARAMETERS WIDTH=16 DEPTH=5 SOURCES fifo_bench.cpp)
gridrt_rtl_bench(rtl_fifo_one TOP gridrt_fifo PARAMETERS WIDTH=16 DEPTH=1 SOURCES fifo_bench.cpp)
