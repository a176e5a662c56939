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
    // What nobody has taken by now may be taken while MPI goes on, so its bytes stay.
    if (!clear_sent() || outgoing_.empty()) return;
    [[maybe_unused]] const auto* kept =
        std::make_unique<std::deque<Outgoing>>(std::move(outgoing_)).release();
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
    int there = 0;
    MPI_Message message{};
    MPI_Status status{};
    const int tag = device == kAnyDevice ? MPI_ANY_TAG : device;
    if (auto done = check(
            MPI_Improbe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &message, &status), "fetch");
        !done) {
      return std::unexpected(std::move(done.error()));
    }
    if (there == 0) return std::nullopt;
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    incoming_.resize(static_cast<std::size_t>(size));
    if (auto done = check(MPI_Mrecv(incoming_.data(), size, MPI_BYTE, &message, MPI_STATUS_IGNORE),
                          "receive");
        !done) {
      return std::unexpected(std::move(done.error()));
    }
    Head head;
    if (incoming_.size() < sizeof(head)) {
      return fail(ErrorKind::kTransport, "a message between ranks is cut short");
    }
    std::memcpy(&head, incoming_.data(), sizeof(head));
    Parcel parcel{
        static_cast<ParcelKind>(head.kind), status.MPI_SOURCE, status.MPI_TAG, head.number, {}};
    parcel.content.assign(incoming_.begin() + sizeof(head), incoming_.end());
    return parcel;
  }

 private:
  struct Outgoing {
    MPI_Request request = MPI_REQUEST_NULL;
    std::vector<std::byte> bytes;
  };

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
  std::vector<std::byte> incoming_;
};

}  // namespace

std::unique_ptr<Postbox> make_mpi_postbox() { return std::make_unique<MpiPostbox>(); }

}  // namespace gridrt
