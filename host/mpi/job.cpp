#include "host/mpi/job.hpp"

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gridrt {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kByItself(5000);   ///< time to end after the socket is closed
constexpr std::chrono::milliseconds kWhenAsked(5000);  ///< and after SIGTERM

bool is_program(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error) && access(path.c_str(), X_OK) == 0;
}

std::optional<std::string> find_program(const char* variable, const char* name, bool beside) {
  if (const char* chosen = std::getenv(variable); chosen != nullptr && *chosen != 0) {
    return is_program(chosen) ? std::optional<std::string>(chosen) : std::nullopt;
  }
  if (beside) {
    std::error_code error;
    const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path() / name;
    if (!error && is_program(here)) return here.string();
  }
  const char* path = std::getenv("PATH");
  std::string_view left = path == nullptr ? "" : path;
  while (!left.empty()) {
    const std::size_t end = std::min(left.find(':'), left.size());
    const fs::path candidate = fs::path(left.substr(0, end)) / name;
    if (end > 0 && is_program(candidate)) return candidate.string();
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return std::nullopt;
}

/// This process's environment without what a launcher has put there for it alone.
std::vector<std::string> clean_environment() {
  constexpr std::array<std::string_view, 6> kOfALauncher = {
      "PMIX_", "PMI_", "OMPI_COMM_WORLD_", "OMPI_MCA_orte_", "OMPI_MCA_ess_", "OMPI_MCA_pmix_"};
  std::vector<std::string> kept;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    bool of_launcher = false;
    for (const std::string_view prefix : kOfALauncher) {
      of_launcher = of_launcher || text.starts_with(prefix);
    }
    if (!of_launcher) kept.emplace_back(text);
  }
  return kept;
}

std::vector<char*> pointers(std::vector<std::string>& words) {
  std::vector<char*> out;
  out.reserve(words.size() + 1);
  for (std::string& word : words) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

}  // namespace

Result<Job> Job::start(int ranks, const std::vector<std::string>& arguments) {
  const auto mpirun = find_program("GRIDRT_MPIRUN", "mpirun", false);
  if (!mpirun) {
    return fail(ErrorKind::kUnsupported, "device 'mpi': mpirun is not found",
                "install openmpi-bin, or set GRIDRT_MPIRUN to its path");
  }
  const auto rank = find_program("GRIDRT_RANK_PROGRAM", "gridrt-rank", true);
  if (!rank) {
    return fail(ErrorKind::kUnsupported, "device 'mpi': the program gridrt-rank is not found",
                "put it beside this program or on PATH, or set GRIDRT_RANK_PROGRAM to its path");
  }
  std::vector<std::string> words = {*mpirun,     "-n",   std::to_string(ranks), "--oversubscribe",
                                    "--bind-to", "none", "--allow-run-as-root", *rank};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<std::string> environment = clean_environment();

  const int output = memfd_create("gridrt-mpirun", MFD_CLOEXEC);
  if (output < 0) return fail(ErrorKind::kDevice, "device 'mpi': no file in memory can be made");
  posix_spawn_file_actions_t files{};
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, output, STDERR_FILENO);
  posix_spawnattr_t attributes{};
  posix_spawnattr_init(&attributes);
  // A group of its own: a Ctrl-C is for this program, which then takes the job along.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  pid_t process = -1;
  const int failed = posix_spawn(&process, mpirun->c_str(), &files, &attributes,
                                 pointers(words).data(), pointers(environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  if (failed != 0) {
    close(output);
    return fail(ErrorKind::kDevice,
                fmt::format("device 'mpi': {} cannot be started: {}", *mpirun, strerror(failed)));
  }
  return Job(process, output);
}

Job::Job(Job&& other) noexcept
    : process_(std::exchange(other.process_, -1)), output_(std::exchange(other.output_, -1)) {}

Job::~Job() {
  if (process_ > 0 && !await_end(kByItself)) {
    kill(process_, SIGTERM);
    if (!await_end(kWhenAsked)) {
      kill(-process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  if (output_ >= 0) close(output_);
}

bool Job::ended() {
  if (process_ > 0 && waitpid(process_, nullptr, WNOHANG) != 0) process_ = -1;
  return process_ < 0;
}

bool Job::await_end(std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds kLook(5);
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!ended()) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(kLook);
  }
  return true;
}

std::string Job::last_words() const {
  std::string text;
  std::array<char, 4096> piece{};
  off_t at = 0;
  for (ssize_t got = 0; (got = pread(output_, piece.data(), piece.size(), at)) > 0; at += got) {
    text.append(piece.data(), static_cast<std::size_t>(got));
  }
  // mpirun frames and wraps what it says: "mpirun noticed that process rank 2 with PID 0 on node n
  // exited on signal 9 (Killed)." Without that sentence, the first line that says anything.
  std::string joined;
  for (const char c : text) joined += c == '\n' ? ' ' : c;
  const std::size_t start = joined.find("mpirun noticed");
  if (start != std::string::npos) {
    return joined.substr(start, std::min(joined.find("  ", start), joined.size()) - start);
  }
  std::string_view left = text;
  while (!left.empty()) {
    const std::size_t end = std::min(left.find('\n'), left.size());
    const std::string_view line = left.substr(0, end);
    if (line.find_first_not_of("- \t") != std::string_view::npos) return std::string(line);
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  return {};
}

}  // namespace gridrt
