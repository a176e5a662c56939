#include "host/mpi/ranks.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <sys/prctl.h>

#include "host/mpi/mpi_library.hpp"
#include "host/mpi/mpi_postbox.hpp"
#include "host/mpi/patience.hpp"
#include "host/mpi/rank_server.hpp"

namespace gridrt {
namespace {

constexpr int kExitDevice = 6;
constexpr std::chrono::seconds kFarewell(10);  ///< longest wait for ranks at the end

bool has_launcher() {
  constexpr std::array kMarks = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  for (const char* mark : kMarks) {
    if (std::getenv(mark) != nullptr) return true;
  }
  return false;
}

/// True if all other ranks have said good-bye.
bool dismiss(int ranks) {
  const auto postbox = make_mpi_postbox();
  for (int to = 1; to < ranks; ++to) {
    if (!postbox->send({ParcelKind::kStop, to, kNoDevice, 0, {}})) return false;
  }
  const auto end = std::chrono::steady_clock::now() + kFarewell;
  Patience patience;
  for (int gone = 0; gone < ranks - 1;) {
    const auto parcel = postbox->receive(kNoDevice);
    if (!parcel || std::chrono::steady_clock::now() > end) return false;
    const std::optional<Parcel>& came = *parcel;
    if (!came) {
      patience.wait(true);
      continue;
    }
    gone += came->kind == ParcelKind::kGone ? 1 : 0;
  }
  return true;
}

}  // namespace

Ranks::Ranks() {
  int initialised = 0;
  MPI_Initialized(&initialised);
  if (initialised != 0 || !has_launcher()) return;
  // A launcher that is killed takes its ranks along.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Reading another rank's memory is forbidden in many containers, and MPI complains at length.
  setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0);
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
  joined_ = true;
}

Ranks::~Ranks() {
  if (!joined_) return;
  if (rank_ == 0 && ranks_ > 1 && !dismiss(ranks_)) MPI_Abort(MPI_COMM_WORLD, kExitDevice);
  MPI_Finalize();
}

int Ranks::serve() const {
  const auto postbox = make_mpi_postbox();
  RankServer server(*postbox);
  const Result<void> served = server.serve();
  if (served) return 0;
  std::fprintf(stderr, "rank %d: %s\n", rank_, served.error().message.c_str());
  abandon();
  return kExitDevice;
}

void Ranks::abandon() const {
  if (joined_) MPI_Abort(MPI_COMM_WORLD, kExitDevice);
}

}  // namespace gridrt
