# The USB block between a UTMI PHY and the board: a USB host on one side, a board in software on the
# other.
gridrt_rtl_bench(rtl_usb TOP gridrt_usb LUNA SOURCES usb_block_test.cpp
                 LINK gridrt_board_model gridrt_firmware_vectors_b17x4 gridrt_pe gridrt_image
                 gridrt_hal)
# The same at a ULPI PHY.
gridrt_rtl_bench(rtl_usb_ulpi TOP gridrt_usb_at_ulpi FILES gridrt_usb_at_ulpi.sv LUNA
                 SOURCES usb_ulpi_test.cpp
                 LINK gridrt_board_model gridrt_firmware_vectors_b17x4 gridrt_pe gridrt_image
                 gridrt_hal)
gridrt_rtl_bench(rtl_usb_tail TOP gridrt_usb_tail PARAMETERS PAUSE=30 SOURCES usb_tail_bench.cpp)
# The whole device: USB block, soft core with its firmware, shell and engine.
gridrt_rtl_bench(rtl_usb_device TOP gridrt_device LUNA FIRMWARE b12x2 PARAMETERS B=12 PES=2
                 SOURCES usb_device_test.cpp usb_noise_test.cpp hostile_usb.cpp hostile_frames.cpp
                         known_image.cpp payloads.cpp
                 LINK gridrt_driver gridrt_pe gridrt_image gridrt_scene gridrt_hal fmt::fmt)
