// An MPI job of this program's own: mpirun as a child process, and what it says.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

#include "hal/error.hpp"

namespace gridrt {

/// mpirun with ranks of gridrt-rank. Nothing that it prints reaches the terminal.
class Job {
 public:
  /// Starts it. `arguments` go to gridrt-rank. Errors: kUnsupported if mpirun (or what
  /// GRIDRT_MPIRUN names) or gridrt-rank (or GRIDRT_RANK_PROGRAM; else sought beside this program
  /// and on PATH) is not there; kDevice if no process can be started.
  static Result<Job> start(int ranks, const std::vector<std::string>& arguments);

  /// Ends the job if it has not ended by itself soon.
  ~Job();
  Job(Job&& other) noexcept;
  Job& operator=(Job&&) = delete;
  Job(const Job&) = delete;
  Job& operator=(const Job&) = delete;

  /// True once mpirun has ended.
  bool ended();

  /// Waits for its end, for so long at the most; true once it has ended.
  bool await_end(std::chrono::milliseconds patience);

  /// One sentence of what mpirun or a rank said about its end, or an empty one.
  [[nodiscard]] std::string last_words() const;

 private:
  Job(pid_t process, int output) : process_(process), output_(output) {}

  pid_t process_;  ///< -1: has ended, or moved away
  int output_;     ///< a file in memory with all that was printed
};

}  // namespace gridrt
