// A device whose answers a test rewrites before the host sees them.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "hal/endpoint.hpp"
#include "hal/frame.hpp"

namespace gridrt::fixture {

/// An answer as a value, so that a test may change any part of it.
struct LooseFrame {
  protocol::FrameHeader header;
  std::vector<std::byte> payload;
};

/// Returns the frames to send instead of one answer (none: it is lost).
using Rewrite = std::function<std::vector<LooseFrame>(LooseFrame)>;

class RewritingEndpoint final : public Endpoint {
 public:
  RewritingEndpoint(std::unique_ptr<Endpoint> inner, Rewrite rewrite)
      : inner_(std::move(inner)), rewrite_(std::move(rewrite)) {}

  Result<void> consume(std::span<const std::byte> bytes) override {
    if (auto done = inner_->consume(bytes); !done) return done;
    std::vector<std::byte> block(1 << 16);
    for (;;) {
      const Result<std::size_t> got = inner_->produce(block, std::chrono::milliseconds(0));
      if (!got) return std::unexpected(got.error());
      if (*got == 0) break;
      reader_.push(std::span(block).first(*got));
    }
    while (const auto event = reader_.next()) {
      const Frame& frame = std::get<Frame>(*event);
      LooseFrame loose{frame.header, {frame.payload.begin(), frame.payload.end()}};
      for (const LooseFrame& f : rewrite_(std::move(loose))) {
        auto built = append_frame(out_, static_cast<protocol::FrameType>(f.header.type),
                                  static_cast<protocol::Layout>(f.header.layout), f.header.sequence,
                                  f.payload);
        if (!built) return built;
      }
    }
    return {};
  }

  Result<std::size_t> produce(std::span<std::byte> out, std::chrono::milliseconds) override {
    const std::size_t count = std::min(out.size(), out_.size());
    std::copy_n(out_.begin(), count, out.begin());
    out_.erase(out_.begin(), out_.begin() + static_cast<std::ptrdiff_t>(count));
    return count;
  }

  Result<void> get_feature(std::uint8_t id, std::span<std::byte> body) override {
    return inner_->get_feature(id, body);
  }
  Result<void> set_feature(std::uint8_t id, std::span<const std::byte> body) override {
    return inner_->set_feature(id, body);
  }

 private:
  std::unique_ptr<Endpoint> inner_;
  Rewrite rewrite_;
  FrameReader reader_;
  std::vector<std::byte> out_;
};

}  // namespace gridrt::fixture
