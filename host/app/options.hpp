// The command lines of gridrt-host and gridrt-image.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/grid/partition.hpp"
#include "host/image/image.hpp"

namespace gridrt {

/// Text to print instead of running (--help, --version).
struct PrintAndExit {
  std::string text;
};

/// How a scene is to be cut; what is not given is the default, or what a .grt brings.
struct CutOptions {
  std::optional<int> bits;
  std::optional<glm::ivec3> grid;  ///< none: chosen from the scene
  std::optional<int> pes;
  std::optional<Mapping> mapping;
  std::optional<protocol::Layout> layout;
};

/// When progress is shown on standard error.
enum class ProgressMode { kAuto, kOn, kOff };

/// gridrt-host.
struct HostOptions {
  std::string scene;
  std::string device = "auto";
  std::string schedule;  ///< empty: the device's own
  bool list_devices = false;
  int threads = 0;            ///< 0: one a core
  int groups = 1;             ///< of the ranks of mpi
  std::size_t batch = 32768;  ///< rays a frame
  CutOptions cut;
  bool exact = false;

  glm::ivec2 size{640, 480};
  int samples = 1;
  int depth = 6;
  std::optional<glm::dvec3> eye;
  std::optional<glm::dvec3> look;
  std::optional<glm::dvec3> up;
  std::optional<double> fov;

  std::string picture;  ///< -o; each of these is empty where not asked for
  std::string rays;
  std::string hits;
  std::string stats;
  std::string lattice;
  std::string trace;
  std::string flash;
  bool any_hit = false;
  std::optional<glm::ivec2> explain;
  ProgressMode progress = ProgressMode::kAuto;

  /// Whether light is computed: for a picture, or to measure one that nobody keeps.
  [[nodiscard]] bool shades() const {
    return rays.empty() && (!picture.empty() || (hits.empty() && lattice.empty() && !explain));
  }
};

/// gridrt-image; exactly one of output, info, verify and firmware is set.
struct ImageProgramOptions {
  std::string scene;
  std::string output;
  std::string info;
  std::string verify;
  std::string firmware;
  CutOptions cut;
  ProgressMode progress = ProgressMode::kAuto;
};

/// Errors: kUsage for everything that the command line gets wrong, kUnsupported for options that
/// are part of the command line but not of this build.
Result<std::variant<HostOptions, PrintAndExit>> parse_host_options(int argc,
                                                                   const char* const* argv);
Result<std::variant<ImageProgramOptions, PrintAndExit>> parse_image_options(
    int argc, const char* const* argv);

}  // namespace gridrt
