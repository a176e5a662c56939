#include "host/driver/upload.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "host/image/image_file.hpp"
#include "host/image/image_frames.hpp"

namespace gridrt {
namespace {

using protocol::ErrorCode;
using protocol::FrameType;
using protocol::SectionKind;

constexpr int kMostAttempts = 64;  ///< commits tried before an upload is given up
constexpr int kMostSilent = 16;    ///< of these, one after the other, without an answer

/// Sends one section, a piece a frame.
Result<void> send_section(Connection& connection, const protocol::CapabilitiesReport& capabilities,
                          const SectionBytes& section) {
  const std::size_t piece = piece_bytes(capabilities.max_payload);
  std::size_t offset = 0;
  do {
    const std::size_t count = std::min(piece, section.bytes.size() - offset);
    std::vector<std::byte> frame;
    auto built = append_piece(frame, section, offset, count, connection.next_sequence());
    if (!built) return built;
    if (auto sent = connection.send(frame); !sent) return sent;
    offset += count;
  } while (offset < section.bytes.size());
  return {};
}

/// What came of a frame that the device answers.
struct Reply {
  bool answered = false;
  protocol::ErrorBody error{};  ///< code 0: it was accepted
};

/// Waits for the answer to `sequence`, skipping answers to other frames.
Result<Reply> wait_for(Connection& connection, std::uint32_t sequence) {
  connection.progress();
  for (;;) {
    const Result<std::optional<Frame>> received = connection.receive();
    if (!received) return std::unexpected(received.error());
    const std::optional<Frame>& frame = *received;
    if (!frame) return Reply{};
    if (frame->header.sequence != sequence) continue;
    if (frame->type() == FrameType::kNoOp) return Reply{true, {}};
    constexpr std::size_t kBytes = protocol::ErrorBody::kBytes;
    if (frame->type() == FrameType::kError && frame->payload.size() == kBytes) {
      return Reply{true, protocol::load_error_body(frame->payload.first<kBytes>())};
    }
  }
}

/// One attempt to commit.
Result<Reply> try_commit(Connection& connection, const Image& image) {
  const std::uint32_t sequence = connection.next_sequence();
  if (auto sent = connection.send(FrameType::kCommit, sequence, commit_payload(image)); !sent) {
    return std::unexpected(sent.error());
  }
  return wait_for(connection, sequence);
}

}  // namespace

Result<void> check_fits(const Image& image, const protocol::CapabilitiesReport& capabilities) {
  const protocol::ImageHeader& h = image.header;
  const auto layout = static_cast<protocol::Layout>(h.layout);
  if (((capabilities.layouts >> h.layout) & 1U) == 0) {
    return fail(ErrorKind::kUnsupported,
                fmt::format("the device does not take images of the {} layout",
                            layout == protocol::Layout::kCompact ? "compact" : "wide"),
                layout == protocol::Layout::kCompact ? "make the image anew with --layout wide"
                                                     : "make the image anew with --layout compact");
  }
  const auto refuse = [](const char* what, std::uint64_t have, std::uint64_t most,
                         const char* advice) {
    return fail(ErrorKind::kLimit,
                fmt::format("the image has {} {}, the device holds {}", have, what, most), advice);
  };
  if (h.bits > capabilities.max_bits) {
    return refuse("lattice bits", h.bits, capabilities.max_bits, "use fewer --bits");
  }
  if (h.pes > capabilities.pes) return refuse("PEs", h.pes, capabilities.pes, "use fewer --pes");
  if (h.occupied_cells > capabilities.max_cells) {
    return refuse("voxels with references", h.occupied_cells, capabilities.max_cells,
                  "use a coarser --grid");
  }
  const glm::ivec3 n = (image.grid().count + 1) / 2;
  const std::uint64_t blocks = std::uint64_t(n.x) * std::uint64_t(n.y) * std::uint64_t(n.z);
  if (blocks > capabilities.max_blocks) {
    return refuse("blocks of voxels", blocks, capabilities.max_blocks, "use a coarser --grid");
  }
  const auto entries = [](const ImageSection& section, std::size_t stride) {
    return section.bytes.size() / stride;
  };
  for (const ImageSection& section : image.sections) {
    if (section.kind == SectionKind::kReferences) {
      const auto count = entries(section, protocol::ReferenceCodec(h).stride());
      if (count > capabilities.max_references) {
        return refuse("references in one PE", count, capabilities.max_references,
                      "use more --pes or a coarser --grid");
      }
    } else if (section.kind == SectionKind::kTriangles) {
      const auto count = entries(section, protocol::TriangleCodec(h).stride());
      if (count > capabilities.max_triangles) {
        return refuse("triangles in one PE", count, capabilities.max_triangles, "use more --pes");
      }
    } else if (section.kind == SectionKind::kVertices) {
      const auto count = entries(section, protocol::VertexCodec(h).stride());
      if (count > capabilities.max_vertices) {
        return refuse("vertices in one PE", count, capabilities.max_vertices, "use more --pes");
      }
    }
  }
  return {};
}

Result<void> upload(Connection& connection, const Image& image,
                    const protocol::CapabilitiesReport& capabilities, std::uint64_t& retries) {
  const std::vector<std::byte> header = header_section(image);
  const auto send_kind = [&](SectionKind kind, std::uint8_t pe) -> Result<void> {
    if (kind == SectionKind::kHeader) {
      return send_section(connection, capabilities, {kind, 0, header});
    }
    const ImageSection* section = image.find(kind, pe);
    if (section == nullptr) {
      return fail(ErrorKind::kProtocol,
                  fmt::format("the device asks for section '{}' of PE {}, which the image does not "
                              "have",
                              protocol::name(kind), pe));
    }
    return send_section(connection, capabilities, {kind, pe, section->bytes});
  };
  const auto send_all = [&]() -> Result<void> {
    if (auto sent = send_kind(SectionKind::kHeader, 0); !sent) return sent;
    for (const ImageSection& section : image.sections) {
      if (!is_for_device(section.kind)) continue;
      if (auto sent = send_kind(section.kind, section.pe); !sent) return sent;
    }
    return {};
  };
  if (auto sent = send_all(); !sent) return sent;
  int silent = 0;
  for (int attempt = 0; attempt < kMostAttempts && silent < kMostSilent; ++attempt) {
    const Result<Reply> reply = try_commit(connection, image);
    if (!reply) return std::unexpected(reply.error());
    const auto code = static_cast<ErrorCode>(reply->error.code);
    if (reply->answered && code == ErrorCode::kNone) return {};
    ++retries;
    silent = reply->answered ? 0 : silent + 1;
    if (!reply->answered || code == ErrorCode::kBadPayloadCrc) continue;
    if (code != ErrorCode::kMissingSection && code != ErrorCode::kBadSectionCrc) {
      return fail(ErrorKind::kDevice,
                  fmt::format("the device refuses the image: {} (detail {})", protocol::name(code),
                              reply->error.detail),
                  "check the file with gridrt-image --verify");
    }
    const auto kind = static_cast<SectionKind>(reply->error.detail & 0xFFU);
    // A device that lost the header has lost what came after it as well.
    const Result<void> again =
        kind == SectionKind::kHeader
            ? send_all()
            : send_kind(kind, static_cast<std::uint8_t>(reply->error.detail >> 8U));
    if (!again) return again;
  }
  if (silent == kMostSilent) {
    return fail(ErrorKind::kTimeout,
                fmt::format("the device is silent: no answer to an image in {} attempts", silent),
                "check the device and its cable");
  }
  return fail(ErrorKind::kTimeout,
              fmt::format("the image could not be loaded in {} attempts", kMostAttempts),
              "check the cable and the device's log");
}

}  // namespace gridrt
