// One run of gridrt-host: from options to files.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/error.hpp"
#include "host/app/lattice_file.hpp"
#include "host/app/options.hpp"
#include "host/app/prepared_scene.hpp"
#include "host/app/progress.hpp"
#include "host/app/statistics.hpp"
#include "host/driver/device.hpp"
#include "host/image/output_file.hpp"
#include "host/render/stream.hpp"
#include "host/render/waves.hpp"

namespace gridrt {

/// Opens the device and all output files first, so that what cannot work fails before the work;
/// then loads, traces, writes every output, and last puts all files in place.
class HostRun {
 public:
  explicit HostRun(const HostOptions& options) : options_(options), progress_(options.progress) {}

  Result<void> run();

 private:
  struct Outputs {
    OutputFile picture;
    OutputFile hits;
    OutputFile lattice;
    OutputFile stats;
  };

  Result<void> open();
  Result<void> load();
  Result<void> trace();
  [[nodiscard]] StreamOptions stream_options() const;
  Result<void> trace_given_rays();
  Result<void> trace_picture();
  Result<void> explain_pixel(const PinholeCamera& camera);
  Result<void> write();
  PrimarySink recorder();
  ProgressSink reporter();

  const HostOptions& options_;
  Progress progress_;
  std::unique_ptr<Device> device_;
  Outputs outputs_;
  PreparedScene prepared_;
  RunStatistics statistics_;
  LatticeRecorder lattice_;
  std::optional<Film> film_;
  std::string explanation_;
};

/// The camera of the command line over that of the scene, or one that shows everything.
Camera choose_camera(const HostOptions& options, const Scene& scene);

}  // namespace gridrt
