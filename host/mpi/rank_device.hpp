// Rank 0's device: software PEs behind the packet protocol whose crew are the ranks of this job.
#pragma once

#include <memory>

#include "host/mpi/connect.hpp"
#include "host/pe/software_device.hpp"

namespace gridrt {

/// Needs MPI to be initialised; this is rank 0.
std::unique_ptr<SoftwareDevice> make_rank_device(const RankOptions& options);

}  // namespace gridrt
