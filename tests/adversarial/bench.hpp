// A device beside the truth: the same scene in both, the same rays through both, every answer
// compared.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/driver/device.hpp"
#include "host/image/chunks.hpp"
#include "tests/adversarial/random.hpp"
#include "tests/truth/tracer.hpp"

namespace gridrt::adversarial {

/// How the device side is set up; nothing of it may change an answer.
struct Configuration {
  DeviceOptions device;
  ImageOptions image;
};

/// seq, omp or seq-board, or one of those that GRIDRT_DEVICES names; 1, 2, 4 or 8 PEs; any mapping,
/// grid, batch size, thread count and layout; omp in the schedules rays and pes.
Configuration random_configuration(Random& random, int bits);

/// One line that tells a configuration.
std::string describe(const Configuration& configuration);

/// What was compared and what differed.
struct Tally {
  std::size_t rays = 0;
  std::size_t hits = 0;
  std::size_t differences = 0;
  std::string first;  ///< the first difference, in full

  void add(std::string difference);
  Tally& operator+=(const Tally& other);
};

/// An open device with a loaded scene, and the truth of that scene.
class Bench {
 public:
  /// What goes beyond the device (lattice bits, PEs, layout) is cut down to it, a scene that does
  /// not fit is loaded in chunks, and a grid too fine for the lattice or the device falls back to
  /// the default one. Of the rays the device gets the part that GRIDRT_FRACTION says; `seq` answers
  /// the others, which are not compared: they are where seq itself is run.
  static Result<Bench> open(const Scene& scene, const Configuration& configuration);

  [[nodiscard]] const truth::Tracer& truth() const { return *truth_; }
  [[nodiscard]] const Lattice& lattice() const { return lattice_; }
  [[nodiscard]] const VoxelGrid& grid() const { return grid_; }
  [[nodiscard]] Device& device() const { return *device_; }
  [[nodiscard]] const SceneImages& images() const { return *images_; }

  /// Rays in scene units: end points, parameters, closest hits (id, t, u, v) and any hits are all
  /// compared. Returns the device's closest hits. `also`: segments on the lattice that follow them
  /// in the same batch; a device that loads a scene in chunks does so once for all.
  std::vector<Hit> check_rays(std::span<const Ray> rays, Tally& tally,
                              std::span<const Segment> also = {}) const;

  /// Segments on the lattice, as they are.
  std::vector<Hit> check_segments(std::span<const Segment> segments, Tally& tally) const;

  /// Both: `segments` are the engine's, `expected` the truth's for the same rays.
  std::vector<Hit> check(std::span<const Segment> segments,
                         std::span<const truth::Segment> expected, Tally& tally) const;

 private:
  Result<SceneImages> build(const Scene& scene);
  [[nodiscard]] Result<void> trace(std::span<const Segment> segments, Query query,
                                   std::span<Hit> hits) const;

  Configuration configuration_;
  Lattice lattice_;
  VoxelGrid grid_;
  std::unique_ptr<truth::Tracer> truth_;
  std::shared_ptr<const SceneImages> images_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Device> stand_in_;  ///< seq, if the device does not get all rays
};

}  // namespace gridrt::adversarial
