# The link of device `sim`, on a small board of its own.
gridrt_rtl_bench(rtl_sim_transport TOP gridrt_sim_probe FILES gridrt_sim_probe.sv TRACE
                 SOURCES sim_transport_bench.cpp LINK gridrt_hal)
