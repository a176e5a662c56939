// What every rank but 0 does: serves the devices that rank 0 opens, until it says that the program
// ends.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>

#include "host/mpi/postbox.hpp"
#include "host/mpi/rank_member.hpp"

namespace gridrt {

class RankServer {
 public:
  /// `postbox` outlives the server.
  explicit RankServer(Postbox& postbox) : postbox_(postbox) {}

  /// Returns when rank 0 has sent kStop. Errors: kTransport.
  Result<void> serve();

  /// Takes one parcel if there is one and does a little work. `idle`: there was neither.
  struct Step {
    bool stopped = false;
    bool idle = false;
  };
  Result<Step> step();

 private:
  struct Served {
    std::unique_ptr<RankMember> member;
    std::uint64_t beat_ns = 0;
    std::uint64_t last_beat = 0;
    bool worked = false;
  };
  Result<void> fetch(std::size_t most, Step& step);
  Result<void> handle(Parcel& parcel);
  Result<void> handle(Served& served, Parcel& parcel);
  void open(const Parcel& parcel);
  void fetch_record(int device, RankMember& member);
  void beat(int device, Served& served, bool worked);

  Postbox& postbox_;
  std::map<int, Served> devices_;
  std::deque<Parcel> deferred_;  ///< fetched in the midst of work
};

}  // namespace gridrt
