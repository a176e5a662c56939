// How ranks write to each other. The code of ranks knows this and nothing of MPI, so that tests
// run ranks as threads and lose what they like.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/error.hpp"

namespace gridrt {

/// What a parcel between ranks is about. A reply goes to who asked.
enum class ParcelKind : std::uint32_t {
  kStop,     ///< to all: the program ends; no device. Replied by kGone
  kOpen,     ///< a device begins: OpenOrder
  kClose,    ///< a device ends; replied by kGone
  kGone,     ///< nothing follows
  kLoad,     ///< LoadHead and a piece of a section; replied by kVerdict
  kCommit,   ///< CommitOrder; replied by kVerdict
  kVerdict,  ///< number: ErrorCode (0: accepted) | detail << 32
  kBatch,    ///< number: of the batch; ray records
  kRecords,  ///< PesRecord array
  kAnswer,   ///< number: of a batch; hit records, of a group that rank 0 is not in
  kRefused,  ///< number: of the batch that this rank cannot work on; why, as kVerdict's number
  kBeat,     ///< number: 1 if there was work since the one before
  kCount,    ///< asks for counters; replied by kCounts
  kCounts,   ///< PeCounters' fields
  kReset,    ///< no image, counters at zero; replied by kVerdict
};

/// A parcel as it was sent. `device` tells parcels of different devices apart.
struct Parcel {
  ParcelKind kind = ParcelKind::kStop;
  int peer = 0;  ///< receiver, or sender once it has come
  int device = 0;
  std::uint64_t number = 0;
  std::vector<std::byte> content;
};

/// Parcels from one rank to another arrive in the order of their sending, or never.
class Postbox {
 public:
  Postbox() = default;
  Postbox(const Postbox&) = delete;
  Postbox& operator=(const Postbox&) = delete;
  virtual ~Postbox() = default;

  [[nodiscard]] virtual int rank() const = 0;
  [[nodiscard]] virtual int ranks() const = 0;

  /// Sends and does not wait. Errors: kTransport.
  virtual Result<void> send(Parcel parcel) = 0;

  /// The next parcel of `device`, or of any if it is kAnyDevice; nothing if there is none now.
  /// Errors: kTransport.
  virtual Result<std::optional<Parcel>> receive(int device) = 0;
};

inline constexpr int kAnyDevice = -1;
inline constexpr int kNoDevice = 0;  ///< of parcels that concern no device

/// The bytes of trivially copyable values; ranks run the same program on like machines.
template <class T>
std::span<const std::byte> raw_bytes(std::span<const T> values) {
  return std::as_bytes(values);
}

}  // namespace gridrt
