// The way to the device `mpi`.
#pragma once

#include <chrono>
#include <memory>

#include "gridrt_protocol.hpp"
#include "hal/error.hpp"
#include "hal/transport.hpp"
#include "host/pe/schedule.hpp"

namespace gridrt {

struct RankOptions {
  ScheduleOptions schedule;  ///< kPes or kPaper
  protocol::CapabilitiesReport capabilities;
  std::chrono::milliseconds silence{10000};  ///< so long may nothing be heard of a rank
  int ranks = 0;   ///< to start where there is no launcher; 0: kDefaultRanks
  int groups = 1;  ///< of ranks, each with a whole set of PEs and a part of the rays; divides ranks
};

inline constexpr int kDefaultRanks = 4;

/// True if this build has the device.
bool mpi_is_built_in();

/// Ranks of the job that this program is rank 0 of (see Ranks); 0 if it is not part of one.
int ranks_of_this_job();

/// Opens the device on this job's ranks or, without a job, starts one with mpirun that lives as
/// long as the transport. In a job, transports are used by one thread, the one that made `Ranks`.
/// Errors: kUsage (groups do not divide the ranks), kUnsupported (not built in, or mpirun or
/// gridrt-rank is not found), kDevice, kTimeout.
Result<std::unique_ptr<Transport>> connect_ranks(const RankOptions& options);

}  // namespace gridrt
