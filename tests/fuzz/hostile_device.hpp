// The far end of a cable that lies: an honest device whose answers and reports the input changes,
// forges, loses, repeats and never ends. Time is virtual.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "hal/crc32c.hpp"
#include "hal/endpoint.hpp"
#include "hal/frame.hpp"
#include "hal/transport.hpp"
#include "tests/fuzz/fuzz_input.hpp"

namespace gridrt::fuzz {

/// What came over the cable; outlives it.
struct Heard {
  bool forged = false;  ///< a frame with good CRCs that the honest device has not said
  std::uint64_t calls = 0;
  std::chrono::milliseconds now{0};
};

class HostileDevice final : public Transport {
 public:
  HostileDevice(std::unique_ptr<Endpoint> honest, Input& input, Heard& heard)
      : honest_(std::move(honest)), input_(input), heard_(heard) {}

  Result<void> send(std::span<const std::byte> bytes) override {
    ++heard_.calls;
    if (endless_) return {};
    if (auto done = honest_->consume(bytes); !done) return done;
    return listen();
  }

  Result<std::size_t> receive(std::span<std::byte> out,
                              std::chrono::milliseconds timeout) override {
    ++heard_.calls;
    if (endless_) {
      const std::vector<std::byte> more = endless_->at >= 2 * endless_->bytes.size() && trickles_
                                              ? std::vector<std::byte>(1)
                                              : endless_->bytes;
      endless_->at += more.size();
      arrive(more);
    } else if (arrived_.empty()) {
      // Nobody asks for more: a frame that was cut short is given up.
      if (auto done = listen(); !done) return std::unexpected(done.error());
    }
    if (broken_) return fail(ErrorKind::kTransport, "unplugged");
    heard_.now += endless_ ? std::max(timeout / 2, std::chrono::milliseconds(1))
                           : std::chrono::milliseconds(1);
    if (arrived_.empty()) heard_.now += timeout;
    const std::size_t most = std::min(out.size(), cut_ == 0 ? out.size() : cut_);
    const std::size_t count = std::min(most, arrived_.size());
    const auto end = arrived_.begin() + static_cast<std::ptrdiff_t>(count);
    std::copy(arrived_.begin(), end, out.begin());
    arrived_.erase(arrived_.begin(), end);
    return count;
  }

  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    ++heard_.calls;
    const auto honest = honest_->get_feature(id, body);
    switch (input_.byte() % 16) {
      case 1:  // one byte is another
        body[input_.byte() % body.size()] ^= std::byte{input_.byte()};
        return {};
      case 2:
        std::ranges::fill(body, std::byte{input_.byte()});
        return {};
      case 3:
        std::ranges::copy(input_.take(body.size()), body.begin());
        return {};
      case 4:
        return fail(ErrorKind::kTransport, "unplugged");
      case 5:
        return fail(ErrorKind::kUnsupported, "no such report");
      case 6:
        return fail(ErrorKind::kTimeout, "silent");
      default:
        return honest;
    }
  }

  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    ++heard_.calls;
    const auto honest = honest_->set_feature(id, body);
    return input_.byte() % 16 == 1 ? Result<void>{} : honest;
  }

  [[nodiscard]] std::chrono::milliseconds now() const override { return heard_.now; }

  /// Transfers of at most so many bytes; 0: as many as there are.
  void set_cut(std::size_t bytes) { cut_ = bytes; }

 private:
  static constexpr std::size_t kMostLookedAt = std::size_t{1} << 16U;

  struct Endless {
    std::vector<std::byte> bytes;
    std::uint64_t at = 0;
  };

  /// What the honest device has to say goes through the input's hands.
  Result<void> listen() {
    for (;;) {
      const auto got = honest_->produce(block_, std::chrono::milliseconds(0));
      if (!got) return std::unexpected(got.error());
      if (*got == 0) return {};
      said_.push(std::span(block_).first(*got));
      while (const auto event = said_.next()) {
        const auto& frame = std::get<Frame>(*event);
        genuine_.emplace(frame.bytes.begin(), frame.bytes.end());
        pass(frame);
      }
    }
  }

  void pass(const Frame& frame) {
    std::vector<std::byte> bytes(frame.bytes.begin(), frame.bytes.end());
    std::vector<std::byte> behind = std::exchange(held_, {});
    switch (input_.byte() % 20) {
      case 1:  // lost
        bytes.clear();
        break;
      case 2:
        bytes[place(bytes.size())] ^= std::byte{input_.byte()};
        break;
      case 3:
        bytes.resize(place(bytes.size()));
        break;
      case 4:
        behind.insert(behind.begin(), bytes.begin(), bytes.end());
        break;
      case 5:
        held_ = std::exchange(bytes, {});
        break;
      case 6:
        arrive(input_.take(input_.byte()));
        break;
      case 7:  // an old answer first
        arrive(*std::next(genuine_.begin(),
                          static_cast<std::ptrdiff_t>(input_.byte() % genuine_.size())));
        break;
      case 8:
        bytes = forge_payload(frame);
        break;
      case 9:
        forge_header(bytes);
        break;
      case 10:
        bytes = forge_frame(frame);
        break;
      case 11:
        begin_endless(frame);
        break;
      case 12:
        broken_ = true;
        break;
      default:
        break;
    }
    arrive(bytes);
    arrive(behind);
  }

  std::size_t place(std::size_t bound) {
    const std::size_t low = input_.byte();
    return (low + 256U * input_.byte()) % bound;
  }

  /// The header's fields, another payload, good CRCs.
  static std::vector<std::byte> frame_of(const protocol::FrameHeader& header,
                                         std::span<const std::byte> payload) {
    std::vector<std::byte> out;
    require(append_frame(out, static_cast<protocol::FrameType>(header.type),
                         static_cast<protocol::Layout>(header.layout), header.sequence, payload)
                .has_value());
    return out;
  }

  std::vector<std::byte> forge_payload(const Frame& frame) {
    std::vector<std::byte> payload(frame.payload.begin(), frame.payload.end());
    if (input_.byte() % 4 == 0) payload.resize(input_.byte());
    for (int changes = 1 + input_.byte() % 8; changes > 0 && !payload.empty(); --changes) {
      payload[place(payload.size())] = std::byte{input_.byte()};
    }
    return frame_of(frame.header, payload);
  }

  void forge_header(std::vector<std::byte>& frame) {
    constexpr std::size_t kCrc = protocol::FrameHeader::kBytes - 4;
    frame[input_.byte() % kCrc] ^= std::byte{input_.byte()};
    protocol::detail::put32(frame.data() + kCrc, crc32c(std::span(frame).first(kCrc)));
  }

  std::vector<std::byte> forge_frame(const Frame& frame) {
    protocol::FrameHeader header = frame.header;
    header.type = input_.byte() % 10;
    header.layout = input_.byte() % 4;
    if (input_.byte() % 4 == 0) header.sequence = input_.word();
    return frame_of(header, input_.take(input_.byte()));
  }

  void begin_endless(const Frame& frame) {
    protocol::FrameHeader header = frame.header;
    std::vector<std::byte> bytes(frame.bytes.begin(), frame.bytes.end());
    switch (input_.byte() % 5) {
      case 0:
        break;  // this answer for ever
      case 1:
        bytes = input_.take(1 + input_.byte());
        break;
      case 2:  // for ever at work
        header.type = static_cast<std::uint8_t>(protocol::FrameType::kNoOp);
        header.sequence = 0;
        bytes = frame_of(header, {});
        break;
      case 3:  // answers to nobody
        header.sequence ^= 0x40000000U;
        bytes = frame_of(header, frame.payload);
        break;
      default: {  // a frame of the greatest length, byte by byte
        std::vector<std::byte> head(protocol::FrameHeader::kBytes);
        header.length = protocol::kMaxPayload;
        protocol::store(header, std::span(head).first<protocol::FrameHeader::kBytes>());
        protocol::detail::put32(head.data() + head.size() - 4, crc32c(std::span(head).first(16)));
        bytes = head;
        trickles_ = true;
        break;
      }
    }
    endless_ = Endless{std::move(bytes)};
  }

  /// Bytes on their way to the host. Every good frame that begins anywhere in them is looked at:
  /// the host may come to search there.
  void arrive(std::span<const std::byte> bytes) {
    arrived_.insert(arrived_.end(), bytes.begin(), bytes.end());
    if (heard_.forged || (endless_ && stream_.size() > kMostLookedAt)) return;
    stream_.insert(stream_.end(), bytes.begin(), bytes.end());
    for (; looked_ + kFrameOverhead <= stream_.size(); ++looked_) {
      const auto rest = std::span<const std::byte>(stream_).subspan(looked_);
      if (protocol::detail::get32(rest.data()) != protocol::kFrameMagic) continue;
      const auto header = protocol::load_frame_header(rest.first<protocol::FrameHeader::kBytes>());
      if (header.header_crc == crc32c(rest.first(protocol::FrameHeader::kBytes - 4)) &&
          header.length <= protocol::kMaxPayload) {
        begun_.push_back(looked_);
      }
    }
    std::erase_if(begun_, [&](std::size_t start) {
      const auto rest = std::span<const std::byte>(stream_).subspan(start);
      const auto header = protocol::load_frame_header(rest.first<protocol::FrameHeader::kBytes>());
      if (rest.size() < kFrameOverhead + header.length) return false;
      const auto whole = rest.first(kFrameOverhead + header.length);
      const auto payload = whole.subspan(protocol::FrameHeader::kBytes, header.length);
      const bool good = protocol::detail::get32(whole.data() + whole.size() - 4) == crc32c(payload);
      if (good && !genuine_.contains({whole.begin(), whole.end()})) heard_.forged = true;
      return true;
    });
  }

  std::unique_ptr<Endpoint> honest_;
  Input& input_;
  Heard& heard_;
  std::vector<std::byte> block_ = std::vector<std::byte>(4096);
  FrameReader said_;                          // by the honest device
  std::set<std::vector<std::byte>> genuine_;  // frames of it
  std::vector<std::byte> held_;               // behind the next one
  std::vector<std::byte> arrived_;            // for the host
  std::vector<std::byte> stream_;             // all that has arrived
  std::size_t looked_ = 0;                    // of stream_
  std::vector<std::size_t> begun_;            // good headers in it whose frames are unfinished
  std::optional<Endless> endless_;
  bool trickles_ = false;
  bool broken_ = false;
  std::size_t cut_ = 0;
};

}  // namespace gridrt::fuzz
