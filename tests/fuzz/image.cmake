# Memory images: files, sections and the deep check.
include(GridrtFuzzer)
gridrt_fuzzer(fuzz_image fuzz_image.cpp LINK gridrt_image LENGTH 256)
