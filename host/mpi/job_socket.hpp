// Where rank 0 of a job reports to the program that has started the job.
#pragma once

#include <chrono>
#include <string>

#include "hal/error.hpp"

namespace gridrt {

/// A socket that listens under an abstract name on this machine.
class JobSocket {
 public:
  /// Errors: kTransport.
  static Result<JobSocket> listen(const std::string& name);

  /// Waits for a connection from a process of the same user; its descriptor, or -1.
  int accept(std::chrono::milliseconds timeout);

  ~JobSocket();
  JobSocket(JobSocket&& other) noexcept;
  JobSocket& operator=(JobSocket&&) = delete;
  JobSocket(const JobSocket&) = delete;
  JobSocket& operator=(const JobSocket&) = delete;

 private:
  explicit JobSocket(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

/// Connects to a JobSocket; a descriptor. Errors: kTransport.
Result<int> connect_job_socket(const std::string& name);

}  // namespace gridrt
