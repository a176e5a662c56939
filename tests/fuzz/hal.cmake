# Frames.
include(GridrtFuzzer)
gridrt_fuzzer(fuzz_frame fuzz_frame.cpp LINK gridrt_hal)
