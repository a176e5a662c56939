# One way to declare a library of the project: warnings are errors, floating
# point means what it says (no contraction: error bounds rely on it).
find_program(GRIDRT_CCACHE ccache)
if(GRIDRT_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${GRIDRT_CCACHE})
endif()

add_library(gridrt_flags INTERFACE)
target_compile_options(gridrt_flags INTERFACE
  -Wall -Wextra -Wpedantic -Werror -Wshadow -Wconversion -Wno-sign-conversion
  -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-align -ffp-contract=off)
if(GRIDRT_SANITIZE)
  target_compile_options(gridrt_flags INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(gridrt_flags INTERFACE -fsanitize=address,undefined)
  target_sources(gridrt_flags INTERFACE  # once a program
    $<$<STREQUAL:$<TARGET_PROPERTY:TYPE>,EXECUTABLE>:${CMAKE_CURRENT_LIST_DIR}/leaks.cpp>)
endif()

# gridrt_library(NAME sources... [LINK public libraries...] [PRIVATE libraries...])
function(gridrt_library name)
  cmake_parse_arguments(ARG "" "" "LINK;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_UNPARSED_ARGUMENTS})
  add_library(GridRT::${name} ALIAS ${name})
  target_include_directories(${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/gridrt>)
  target_compile_features(${name} PUBLIC cxx_std_23)
  target_link_libraries(${name} PUBLIC glm::glm ${ARG_LINK} PRIVATE $<BUILD_INTERFACE:gridrt_flags> ${ARG_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY GRIDRT_LIBRARIES ${name})
endfunction()

# gridrt_program(NAME sources... LINK libraries...)
function(gridrt_program name)
  cmake_parse_arguments(ARG "" "" "LINK" ${ARGN})
  add_executable(${name} ${ARG_UNPARSED_ARGUMENTS})
  target_link_libraries(${name} PRIVATE gridrt_flags ${ARG_LINK})
endfunction()
