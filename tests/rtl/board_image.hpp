// Images for the board that a bench simulates.
#pragma once

#include <cstddef>

#include <glm/vec3.hpp>
#include <gtest/gtest.h>

#include "host/image/image.hpp"
#include "tests/unit/image_support.hpp"

namespace gridrt {

/// Triangles at random (tests/unit/image_support.hpp) in a grid, with the bits and PEs of the
/// bench's board.
inline Image board_image(glm::ivec3 grid, std::size_t triangles, unsigned seed, float size) {
  ImageOptions options;
  options.grid = grid;
  options.bits = GRIDRT_RTL_B;
  options.pes = GRIDRT_RTL_PES;
  options.layout = protocol::Layout::kCompact;
  options.with_scene = false;
  auto built = build_image(random_scene(triangles, seed, size), options);
  EXPECT_TRUE(built) << built.error().message;
  return *built;
}

}  // namespace gridrt
