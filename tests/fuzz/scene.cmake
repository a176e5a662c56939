# Mesh and scene readers: from nothing, and from small good files.
include(GridrtFuzzer)
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
set(seeds ${CMAKE_CURRENT_BINARY_DIR}/scene_seeds)
add_test(NAME fuzz.scene_seeds
  COMMAND ${Python3_EXECUTABLE} -B ${CMAKE_CURRENT_LIST_DIR}/scene_seeds.py ${seeds})
set_tests_properties(fuzz.scene_seeds PROPERTIES FIXTURES_SETUP scene_seeds)
foreach(format obj mtl ply stl gltf glb toml)
  set(target fuzz_scene_${format})
  gridrt_fuzzer(${target} scene_fuzz_${format}.cpp scene_fuzz_support.cpp LINK gridrt_scene)
  add_test(NAME fuzz.${target}.seeded
    COMMAND ${target} -seed=1 -runs=${GRIDRT_FUZZ_RUNS} -max_len=4096 -rss_limit_mb=4096
            -timeout=20 ${seeds}/${target})
  set_tests_properties(fuzz.${target}.seeded PROPERTIES FIXTURES_REQUIRED scene_seeds)
endforeach()
