#include "host/mpi/ranks.hpp"

#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "host/mpi/mpi_library.hpp"
#include "host/mpi/mpi_postbox.hpp"
#include "host/mpi/patience.hpp"
#include "host/mpi/rank_server.hpp"

namespace gridrt {
namespace {

constexpr int kExitDevice = 6;
constexpr std::chrono::seconds kFarewell(10);  ///< longest wait for ranks at the end
constexpr int kAbortMs = 10000;                ///< longest wait for a launcher to end its job

bool has_launcher() {
  constexpr std::array kMarks = {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"};
  for (const char* mark : kMarks) {
    if (std::getenv(mark) != nullptr) return true;
  }
  return false;
}

/// Sees to it that the launcher ends, and with it its ranks (Ranks::Ranks): launchers have been
/// seen to deadlock when told to end their job. A process of its own, which keeps nothing open and
/// outlives this one; it is gone as soon as the launcher is.
void watch_end(pid_t launcher) {
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, launcher, 0));
  if (handle < 0 || fork() != 0) return;
  constexpr int kKept = 3;
  setsid();
  if (dup2(handle, kKept) == kKept) {
    close_range(0, kKept - 1, 0);
    close_range(kKept + 1, ~0U, 0);
    pollfd end{kKept, POLLIN, 0};
    if (poll(&end, 1, kAbortMs) == 0) syscall(SYS_pidfd_send_signal, kKept, SIGKILL, nullptr, 0);
  }
  _exit(0);
}

/// Ends the whole job, at once if the launcher can.
[[noreturn]] void end_job(pid_t launcher) {
  watch_end(launcher);
  MPI_Abort(MPI_COMM_WORLD, kExitDevice);
  _exit(kExitDevice);
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
  launcher_ = getppid();
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
  if (rank_ == 0 && ranks_ > 1 && !dismiss(ranks_)) end_job(launcher_);
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
  if (joined_) end_job(launcher_);
}

}  // namespace gridrt
