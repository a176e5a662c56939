# The shell: images, rays, faults of the link and registers, around a stand-in engine.
gridrt_rtl_bench(rtl_shell TOP gridrt_shell
                 PARAMETERS B=17 PES=4 BLOCKS=4096 CELLS=8192 REFS=11264 TRIS=4096 VERTS=2560
                 SOURCES shell_bench.cpp shell_link_test.cpp shell_load_test.cpp shell_reports_test.cpp
                 shell_trace_test.cpp
                 LINK gridrt_driver gridrt_pe gridrt_image gridrt_scene gridrt_hal)
