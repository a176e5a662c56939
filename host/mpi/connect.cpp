#include "host/mpi/connect.hpp"

#include <utility>

#include "hal/loopback.hpp"
#include "host/mpi/job_transport.hpp"
#include "host/mpi/mpi_library.hpp"
#include "host/mpi/rank_device.hpp"

namespace gridrt {

bool mpi_is_built_in() { return true; }

int ranks_of_this_job() {
  int initialised = 0;
  int finalised = 0;
  MPI_Initialized(&initialised);
  MPI_Finalized(&finalised);
  if (initialised == 0 || finalised != 0) return 0;
  int ranks = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  return ranks;
}

Result<std::unique_ptr<Transport>> connect_ranks(const RankOptions& options) {
  if (ranks_of_this_job() == 0) return start_job(options);
  return std::make_unique<LoopbackTransport>(make_rank_device(options));
}

}  // namespace gridrt
