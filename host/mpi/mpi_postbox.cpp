#include "host/mpi/mpi_postbox.hpp"

#include <array>
#include <cstring>
#include <deque>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "host/mpi/mpi_library.hpp"

namespace gridrt {
namespace {

/// Precedes the content.
struct Head {
  std::uint32_t kind = 0;
  std::uint32_t reserved = 0;
  std::uint64_t number = 0;
};

class MpiPostbox final : public Postbox {
 public:
  MpiPostbox() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks_);
  }

  ~MpiPostbox() override {
    // What is under way by now may end while MPI goes on, so its bytes stay.
    if (!clear_sent() || !outgoing_.empty()) keep(std::move(outgoing_));
    if (!incoming_.empty()) keep(std::move(incoming_));
  }

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int ranks() const override { return ranks_; }

  Result<void> send(Parcel parcel) override {
    if (auto done = clear_sent(); !done) return done;
    Outgoing& out = outgoing_.emplace_back();
    const Head head{static_cast<std::uint32_t>(parcel.kind), 0, parcel.number};
    out.bytes.resize(sizeof(Head) + parcel.content.size());
    std::memcpy(out.bytes.data(), &head, sizeof(Head));
    if (!parcel.content.empty()) {
      std::memcpy(out.bytes.data() + sizeof(Head), parcel.content.data(), parcel.content.size());
    }
    return check(MPI_Isend(out.bytes.data(), static_cast<int>(out.bytes.size()), MPI_BYTE,
                           parcel.peer, parcel.device, MPI_COMM_WORLD, &out.request),
                 "send");
  }

  Result<std::optional<Parcel>> receive(int device) override {
    if (auto done = clear_sent(); !done) return std::unexpected(std::move(done.error()));
    if (auto done = begin_receive(device); !done) return std::unexpected(std::move(done.error()));
    // What comes from one rank stays in order; what another sends does not wait for it.
    late_.assign(static_cast<std::size_t>(ranks_), false);
    for (auto in = incoming_.begin(); in != incoming_.end(); ++in) {
      if (late_[static_cast<std::size_t>(in->peer)]) continue;
      if (device != kAnyDevice && in->device != device) continue;
      int there = 0;
      const int code = MPI_Test(&in->request, &there, MPI_STATUS_IGNORE);
      if (auto done = check(code, "receive"); !done)
        return std::unexpected(std::move(done.error()));
      if (there == 0) {
        late_[static_cast<std::size_t>(in->peer)] = true;
        continue;
      }
      Head head;
      if (in->bytes.size() < sizeof(head)) {
        return fail(ErrorKind::kTransport, "a message between ranks is cut short");
      }
      std::memcpy(&head, in->bytes.data(), sizeof(head));
      Parcel parcel{static_cast<ParcelKind>(head.kind), in->peer, in->device, head.number, {}};
      parcel.content.assign(in->bytes.begin() + sizeof(head), in->bytes.end());
      spare_ = std::move(in->bytes);
      incoming_.erase(in);
      return parcel;
    }
    return std::nullopt;
  }

 private:
  struct Outgoing {
    MPI_Request request = MPI_REQUEST_NULL;
    std::vector<std::byte> bytes;
  };

  /// A message that has begun to come. Its sender may stop before it is all there.
  struct Incoming {
    int peer = 0;
    int device = 0;
    MPI_Request request = MPI_REQUEST_NULL;
    std::vector<std::byte> bytes;
  };

  template <typename Messages>
  static void keep(Messages messages) {
    [[maybe_unused]] const auto* kept = std::make_unique<Messages>(std::move(messages)).release();
  }

  /// Of messages that have begun to come, not so many that memory could run out.
  static constexpr std::size_t kMostIncoming = 64;

  /// Begins to take the next message for the device, if there is one.
  Result<void> begin_receive(int device) {
    if (incoming_.size() >= kMostIncoming) return {};
    int there = 0;
    MPI_Message message{};
    MPI_Status status{};
    const int tag = device == kAnyDevice ? MPI_ANY_TAG : device;
    const int code = MPI_Improbe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &message, &status);
    if (auto done = check(code, "fetch"); !done || there == 0) return done;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Incoming& in = incoming_.emplace_back();
    in.peer = status.MPI_SOURCE;
    in.device = status.MPI_TAG;
    in.bytes = std::exchange(spare_, {});
    in.bytes.resize(static_cast<std::size_t>(size));
    return check(MPI_Imrecv(in.bytes.data(), size, MPI_BYTE, &message, &in.request), "receive");
  }

  static Result<void> check(int code, const char* what) {
    if (code == MPI_SUCCESS) return {};
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    MPI_Error_string(code, text.data(), &length);
    return fail(ErrorKind::kTransport, fmt::format("MPI cannot {} a message: {}", what,
                                                   std::string(text.data(), std::size_t(length))));
  }

  /// Lets go of what has been sent.
  Result<void> clear_sent() {
    while (!outgoing_.empty()) {
      int sent = 0;
      const int code = MPI_Test(&outgoing_.front().request, &sent, MPI_STATUS_IGNORE);
      if (auto done = check(code, "send"); !done) return done;
      if (sent == 0) break;
      outgoing_.pop_front();
    }
    return {};
  }

  int rank_ = 0;
  int ranks_ = 1;
  std::deque<Outgoing> outgoing_;
  std::deque<Incoming> incoming_;  ///< in the order in which they have begun
  std::vector<bool> late_;         ///< ranks of which one has begun and is not there
  std::vector<std::byte> spare_;   ///< memory of the last one
};

}  // namespace

std::unique_ptr<Postbox> make_mpi_postbox() { return std::make_unique<MpiPostbox>(); }

}  // namespace gridrt
