// What the case tests share: open a bench or fail, and tell the result of a case in one line.
#pragma once

#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "tests/adversarial/bench.hpp"
#include "tests/adversarial/devices.hpp"
#include "tests/adversarial/meshes.hpp"
#include "tests/adversarial/rays.hpp"

namespace gridrt::adversarial {

/// Adds the case's tally to the test's result: any difference fails it.
inline void report(const std::string& name, const Tally& tally) {
  std::printf("%s: %zu rays, %zu hits, %zu differences\n", name.c_str(), tally.rays, tally.hits,
              tally.differences);
  EXPECT_GT(tally.rays, 0U) << name;
  EXPECT_EQ(tally.differences, 0U) << name << ": " << tally.first;
}

/// Opens a bench and hands it to `use`; an error fails the test.
template <class Use>
void with_bench(const Scene& scene, const Configuration& configuration, const Use& use) {
  auto bench = Bench::open(scene, configuration);
  ASSERT_TRUE(bench) << bench.error().message << " (" << describe(configuration) << ")";
  use(*bench);
}

/// A configuration with a fixed grid and layout, one device.
inline Configuration plain_configuration(int bits = kDefaultBits,
                                         std::optional<glm::ivec3> grid = {}) {
  Configuration s;
  const std::vector<std::string> asked = asked_devices();
  s.device.name = asked.empty() ? "seq" : asked.front();
  s.image.bits = bits;
  s.image.grid = grid;
  s.image.with_scene = false;
  return s;
}

}  // namespace gridrt::adversarial
