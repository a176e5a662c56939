// A device as the renderer sees it: load an image, trace segments, read counters.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gridrt_protocol.hpp"
#include "hal/error.hpp"
#include "host/grid/segment.hpp"
#include "host/image/image.hpp"
#include "host/pe/explain.hpp"

namespace gridrt {

/// The answer to one ray. A miss: id -1, t infinite, u = v = 0. An any-hit answer: id 0 or -1,
/// t = u = v = NaN.
struct Hit {
  std::int32_t id = -1;  ///< global triangle id
  double t = std::numeric_limits<double>::infinity();
  double u = 0.0;
  double v = 0.0;
};

/// Which question a batch asks.
enum class Query { kClosestHit, kAnyHit };

/// How to open a device and talk to it.
struct DeviceOptions {
  std::string name = "auto";  ///< auto, seq, omp, mpi, sim or usb[:SERIAL]
  std::string schedule = {};  ///< of software PEs: rays, pes or paper; empty: the
                              ///< device's own (omp: rays, mpi: pes)
  /// Of omp's schedule rays: plain (as seq), or a kind of vectors (host/pe/ray_stream.hpp) such as
  /// baseline, sse4, avx2 and avx512; empty: the widest that this processor has.
  std::string simd = {};
  int ranks = 0;    ///< of mpi, started alone; 0: four
  int groups = 1;   ///< of mpi's ranks, each with a whole set of PEs and a part of the rays;
                    ///< divides their number
  int threads = 0;  ///< of omp, and of the host's own work for any device but seq and mpi; 0: all
                    ///< cores (paper: one for each PE)
  std::size_t rays_per_frame = 32768;  ///< batch size on the link, >= 1
  int frames_in_flight = 4;            ///< >= 1
  int timeout_ms = 10000;              ///< longest wait for one answer
  bool spread_rays = true;  ///< to a clocked device: neighbours far apart (ray_order.hpp)
  std::string waves = {};   ///< of sim: an FST file for all signals; empty: none
  std::string flash = {};   ///< of sim: a flash image for the board to start from; empty: none
  /// Software PEs that say, and keep to, less than they could: for tests. The device `seq-board`
  /// is `seq` with board_capabilities().
  std::optional<protocol::CapabilitiesReport> capabilities = std::nullopt;
  bool pes_interrupt = true;  ///< schedule pes: a hit cancels the voxels behind it
  bool pes_feedback = true;   ///< schedule pes: a hit waits for the voxels before it.
                              ///< Both are for measurements; without feedback,
                              ///< answers are wrong
};

/// What a device has done since it was opened.
struct DeviceCounters {
  std::uint64_t rays = 0;        ///< traced (segments that are misses by definition are not sent)
  std::uint64_t steps = 0;       ///< traversal steps
  std::uint64_t tests = 0;       ///< exact triangle tests
  std::uint64_t masked = 0;      ///< references skipped by their quarters
  std::uint64_t interrupts = 0;  ///< later voxels cancelled by a hit
  std::uint64_t feedback_waits = 0;  ///< hits that waited for an earlier voxel's answer
  std::uint64_t cycles = 0;          ///< of a clocked device, else 0
  std::uint64_t bytes_out = 0;
  std::uint64_t bytes_in = 0;
  std::uint64_t frames_retried = 0;
  std::uint64_t uploads = 0;          ///< images loaded
  double upload_seconds = 0.0;        ///< that took
  protocol::ExchangeReport exchange;  ///< of software PEs, else 0
  protocol::AheadReport ahead;        ///< the same
};

/// An open device. Results depend on the scene alone, never on the device or its options.
class Device {
 public:
  virtual ~Device() = default;

  /// Loads an image; replaces the one before.
  virtual Result<void> load(const Image& image) = 0;

  /// Answers segments in their order. `hits.size()` equals `segments.size()`. Needs a loaded image.
  virtual Result<void> trace(std::span<const Segment> segments, Query query,
                             std::span<Hit> hits) = 0;

  virtual Result<DeviceCounters> counters() = 0;

  /// Traces one segment and tells its life. `image` is the loaded one, or a chunk of the loaded
  /// scene. A board's event log tells what happened in it; for the others software PEs do it again.
  virtual Result<std::vector<ExplainEvent>> explain(const Image& image, const Segment& segment) {
    return gridrt::explain(image, segment);
  }

  /// What the device says it can do.
  [[nodiscard]] virtual const protocol::CapabilitiesReport& capabilities() const = 0;

  /// The name that was opened, with `auto` resolved.
  [[nodiscard]] virtual std::string name() const = 0;
};

/// What `auto` means here and now: usb if a board can be used, else mpi in a job of several ranks,
/// else omp; and why, as a clause that may follow "DEVICE: ".
struct AutoChoice {
  std::string name;
  std::string reason;
};
AutoChoice choose_device();

/// Opens a device by name. Errors: kUsage for an unknown name, kUnsupported for one that this
/// build does not have (the advice lists those it has).
Result<std::unique_ptr<Device>> open_device(const DeviceOptions& options);

/// The schedule that a software device has when none is asked for.
std::string_view default_schedule(std::string_view device);

/// Names that open_device accepts in this build; contract tests run on each. Left out: `auto`, and
/// what is there for tests: `seq-board`, and `sim:BOARD` besides
/// `sim`.
std::vector<std::string> built_in_devices();

}  // namespace gridrt
