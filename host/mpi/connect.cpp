#include "host/mpi/connect.hpp"

#include <utility>

#include <fmt/format.h>

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
  const int job = ranks_of_this_job();
  const int ranks = job > 0 ? job : options.ranks > 0 ? options.ranks : kDefaultRanks;
  if (options.groups < 1 || ranks % options.groups != 0) {
    return fail(
        ErrorKind::kUsage,
        fmt::format("{} ranks cannot be split into {} groups of one size", ranks, options.groups),
        job > 0 ? "use a number of groups that divides the ranks, or mpirun -n with another"
                : "use a number of groups that divides the ranks, or mpirun -n with more");
  }
  if (job == 0) return start_job(options);
  return std::make_unique<LoopbackTransport>(make_rank_device(options));
}

}  // namespace gridrt
