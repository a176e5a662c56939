// What stands in for the room where MPI is not built in.
#include "host/mpi/connect.hpp"
#include "host/mpi/ranks.hpp"

namespace gridrt {

Ranks::Ranks() = default;
Ranks::~Ranks() = default;
int Ranks::serve() const { return 0; }
void Ranks::abandon() const {}

bool mpi_is_built_in() { return false; }
int ranks_of_this_job() { return 0; }

Result<std::unique_ptr<Transport>> connect_ranks(const RankOptions& /*options*/) {
  return fail(ErrorKind::kUnsupported, "this build has no MPI");
}

}  // namespace gridrt
