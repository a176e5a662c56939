# Both ends of a hostile cable: the host's driver, and the board's firmware.
include(GridrtFuzzer)
gridrt_fuzzer(fuzz_device fuzz_device.cpp LINK gridrt_driver gridrt_pe gridrt_image gridrt_hal
              LENGTH 1024 SHARE 10)
gridrt_fuzzer(fuzz_firmware fuzz_firmware.cpp
              LINK gridrt_board_model gridrt_firmware_vectors_b17x4 gridrt_driver gridrt_pe
                   gridrt_image gridrt_hal
              LENGTH 512 SHARE 40 TIMEOUT 120)
