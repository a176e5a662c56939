// Frames of a hostile host, for tests of the RTL: random bytes, every field changed and the CRCs
// made right again, sections that lie, more promised than comes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "host/image/image.hpp"

namespace gridrt::rtl {

/// Records that each kind's memory holds, by kind (shell.cmake; the same on every board).
inline constexpr std::array<std::uint32_t, 6> kHolds{0, 4096, 6144, 8192, 4096, 2560};

class HostileFrames {
 public:
  /// `image` is what the lies are about, and must outlive this. Without `loads`, no header of a
  /// LoadSection or Commit frame has a right CRC: nothing can change what is loaded.
  HostileFrames(std::uint64_t seed, const Image& image, bool loads = true)
      : random_(seed), image_(image), loads_(loads) {}

  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random_() % bound); }
  /// Values at the edges of what is checked, and any.
  std::uint32_t value();
  std::vector<std::byte> bytes(std::size_t count);

  /// A frame with a right CRC; now and then one field of its header is not as it should be.
  std::vector<std::byte> frame(protocol::FrameType type, std::span<const std::byte> payload);
  /// Of any type.
  std::vector<std::byte> any();
  /// A good header that promises more than comes.
  std::vector<std::byte> promise();
  /// Rays, not all of them where they should be.
  std::vector<std::byte> trace();
  std::vector<std::byte> commit();
  /// A piece of nothing, anywhere.
  std::vector<std::byte> load();
  /// All sections of the image: one of another length, with bytes of it changed, its CRC in the
  /// header right or not: what the loader's own checks are for.
  std::vector<std::byte> sections();

 private:
  std::uint32_t size_of(const ImageSection& section);
  protocol::FrameType type(std::uint32_t first, std::uint32_t count);

  std::mt19937_64 random_;
  const Image& image_;
  bool loads_;
};

}  // namespace gridrt::rtl
