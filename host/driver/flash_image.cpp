#include "host/driver/flash_image.hpp"

#include <bit>

#include <fmt/format.h>

#include "hal/crc32c.hpp"
#include "host/driver/upload.hpp"
#include "host/image/image_frames.hpp"

namespace gridrt {

Fingerprint fingerprint(const Image& image) {
  // Two 64-bit hashes of different kinds: FNV-1a, and multiply and rotate.
  constexpr std::uint64_t kFnvPrime = 0x100000001B3;
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;
  constexpr int kTurn = 29;
  std::uint64_t a = 0xCBF29CE484222325;
  std::uint64_t b = 0x6A09E667F3BCC908;
  const auto add = [&](std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) {
      const auto value = std::to_integer<std::uint64_t>(byte);
      a = (a ^ value) * kFnvPrime;
      b = std::rotl(b + value, kTurn) * kOdd;
    }
  };
  // What the header says but for its sections, some of which are the host's own.
  protocol::ImageHeader header = image.header;
  header.sections = 0;
  std::array<std::byte, protocol::ImageHeader::kBytes> head{};
  protocol::store(header, head);
  add(head);
  for (const ImageSection& section : image.sections) {
    if (!is_for_device(section.kind)) continue;
    const std::array<std::byte, 2> name{static_cast<std::byte>(section.kind),
                                        static_cast<std::byte>(section.pe)};
    std::array<std::byte, 4> size{};
    protocol::detail::put32(size.data(), static_cast<std::uint32_t>(section.bytes.size()));
    add(name);
    add(size);
    add(section.bytes);
  }
  Fingerprint out{};
  for (std::size_t i = 0; i < 8; ++i) {
    out[i] = static_cast<std::uint8_t>(a >> (8 * i));
    out[8 + i] = static_cast<std::uint8_t>(b >> (8 * i));
  }
  return out;
}

Result<std::vector<std::byte>> flash_image(const Image& image,
                                           const protocol::CapabilitiesReport& capabilities) {
  if (image.header.chunks != 1) {
    return fail(
        ErrorKind::kLimit,
        fmt::format("the scene takes {} chunks, a flash image holds one", image.header.chunks),
        "use a scene with fewer triangles");
  }
  if (auto fits = check_fits(image, capabilities); !fits) {
    return std::unexpected(std::move(fits.error()));
  }
  std::uint32_t sequence = 1;
  auto frames = image_frames(image, capabilities.max_payload, sequence);
  if (!frames) return frames;
  if (frames->size() > protocol::kFlashMaxBytes) {
    return fail(ErrorKind::kLimit,
                fmt::format("the flash image would have {} bytes, at most {} fit", frames->size(),
                            protocol::kFlashMaxBytes));
  }
  protocol::FlashHeader header;
  header.magic = protocol::kFlashMagic;
  header.version = static_cast<std::uint16_t>(protocol::kFlashVersion);
  header.bytes = static_cast<std::uint32_t>(frames->size());
  header.fingerprint = fingerprint(image);
  header.commit = sequence - 1;
  std::array<std::byte, protocol::FlashHeader::kBytes> head{};
  protocol::store(header, head);
  header.header_crc = crc32c(std::span(head).first(protocol::FlashHeader::kBytes - 4));
  protocol::store(header, head);
  frames->insert(frames->begin(), head.begin(), head.end());
  return frames;
}

}  // namespace gridrt
