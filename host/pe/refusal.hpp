// Why a software device refuses an image: a code and detail of the protocol.
#pragma once

#include <cstdint>
#include <expected>

#include "gridrt_protocol.hpp"

namespace gridrt {

/// What the device says in an Error frame.
struct Refusal {
  protocol::ErrorCode code = protocol::ErrorCode::kInternal;
  std::uint32_t detail = 0;
};

template <class T>
using Accepted = std::expected<T, Refusal>;

/// Detail of errors about a section: kind + 256 PE.
inline std::uint32_t section_detail(protocol::SectionKind kind, std::uint32_t pe = 0) {
  return static_cast<std::uint32_t>(kind) + 256U * pe;
}

inline std::unexpected<Refusal> refuse(protocol::ErrorCode code, std::uint32_t detail) {
  return std::unexpected(Refusal{code, detail});
}

}  // namespace gridrt
