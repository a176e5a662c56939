// A program's part in an MPI job: where a launcher (mpirun) started it, rank 0 is the program that
// the user sees and the others serve it.
#pragma once

namespace gridrt {

/// What main() begins with. Without a launcher, or built without MPI, it does nothing.
///
///     const Ranks ranks;
///     if (ranks.serves()) return ranks.serve();
class Ranks {
 public:
  /// Initialises MPI if a launcher started this process. Every process of the job must do it.
  Ranks();
  /// On rank 0, lets the others end; ends the whole job if one of them does not.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  /// True for all ranks but 0.
  [[nodiscard]] bool serves() const { return rank_ > 0; }

  /// Serves until rank 0 is done; returns the program's exit code.
  [[nodiscard]] int serve() const;

  /// Ends the whole job at once, whatever its ranks do. Does not return where there is a job.
  void abandon() const;

 private:
  bool joined_ = false;
  int launcher_ = 0;  ///< process that started this one
  int rank_ = 0;
  int ranks_ = 1;
};

}  // namespace gridrt
