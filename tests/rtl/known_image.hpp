// Images that tests tell from each other by the answers to rays, whatever else a board hears.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gridrt_protocol.hpp"
#include "hal/frame.hpp"
#include "hal/transport.hpp"
#include "host/image/image.hpp"

namespace gridrt::rtl {

/// An image that is told from others by its answers to known rays.
struct KnownImage {
  Image image;
  std::vector<std::byte> frames;  ///< that load it
  std::vector<std::byte> hits;    ///< the payload of the answer to known_rays(), from software PEs
};

KnownImage make_known(Image image);

/// Rays whose answers are known.
std::span<const protocol::RayCompact> known_rays();
std::vector<std::byte> known_trace(std::uint32_t sequence);

/// A device's answer to a frame, if one came.
struct Reply {
  bool came = false;
  protocol::FrameType type = protocol::FrameType::kNoOp;
  std::vector<std::byte> payload;
};

Reply ask(Transport& link, FrameReader& reader, std::span<const std::byte> frame,
          std::uint32_t sequence);

/// NoOps with the numbers from `sequence` on until one is answered, as the device usb begins: an
/// unfinished frame may swallow some.
void synchronise(Transport& link, FrameReader& reader, std::uint32_t sequence);

}  // namespace gridrt::rtl
