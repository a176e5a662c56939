# The configurations of the board that can be simulated, each with a firmware of its own:
# GRIDRT_SIM_BOARDS, a list of NAME:BITS:PES, the default first.
option(GRIDRT_SIM_ALL_BOARDS "Simulate every configuration of the RTL (tools/sim-run)" OFF)
set(GRIDRT_SIM_BOARDS b17x4:17:4)
if(GRIDRT_BUILD_TESTS OR GRIDRT_SIM_ALL_BOARDS)
  list(APPEND GRIDRT_SIM_BOARDS b12x2:12:2)
endif()
if(GRIDRT_SIM_ALL_BOARDS)
  foreach(bits 12 14 17)
    foreach(pes 1 2 4)
      list(APPEND GRIDRT_SIM_BOARDS b${bits}x${pes}:${bits}:${pes})
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES GRIDRT_SIM_BOARDS)
endif()

# gridrt_split_board(BOARD): sets board_name, board_bits and board_pes.
macro(gridrt_split_board board)
  string(REPLACE ":" ";" board_words "${board}")
  list(GET board_words 0 board_name)
  list(GET board_words 1 board_bits)
  list(GET board_words 2 board_pes)
endmacro()
