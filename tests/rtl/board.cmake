# The board with its firmware on the soft core: reports, self-test, flash, hangs. One that can be hung
# on purpose, with short limits.
gridrt_rtl_bench(rtl_board TOP gridrt_board FIRMWARE b12x2 DEFINES GRIDRT_TEST_HANG
  PARAMETERS B=12 PES=2 HANG_CLOCKS=20000 BUS_CLOCKS=20000
  SOURCES board_firmware_test.cpp board_faults_test.cpp board_noise_test.cpp hostile_board.cpp known_image.cpp
          hostile_frames.cpp payloads.cpp
  LINK gridrt_driver gridrt_pe gridrt_image gridrt_scene gridrt_hal)
# Its watch and its mailbox alone.
gridrt_rtl_bench(rtl_watch TOP gridrt_watch PARAMETERS HANG_CLOCKS=1024 ALIVE_CLOCKS=2048
                 SOURCES watch_bench.cpp LINK gridrt_hal)
gridrt_rtl_bench(rtl_mailbox TOP gridrt_mailbox SOURCES mailbox_bench.cpp LINK gridrt_hal)
