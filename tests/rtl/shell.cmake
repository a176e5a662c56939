# The shell: images, rays, faults of the link and registers, around a stand-in engine; as it is, and
# with streams that stall at random.
set(shell_model TOP gridrt_shell
  PARAMETERS B=17 PES=4 BLOCKS=4096 CELLS=6144 REFS=8192 TRIS=4096 VERTS=2560)
set(shell_sources payloads.cpp shell_bench.cpp shell_link_test.cpp shell_load_test.cpp
  shell_reports_test.cpp shell_trace_test.cpp)
set(shell_libraries gridrt_driver gridrt_pe gridrt_image gridrt_scene gridrt_hal)
gridrt_rtl_bench(rtl_shell ${shell_model} SOURCES ${shell_sources} hostile_frames.cpp
                 shell_noise_test.cpp shell_pace_test.cpp
                 LINK ${shell_libraries})
gridrt_rtl_bench(rtl_shell_stall ${shell_model} DEFINES GRIDRT_STALL SOURCES ${shell_sources}
                 LINK ${shell_libraries})
