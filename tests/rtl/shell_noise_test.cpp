// A hostile host at gridrt_shell: random bytes, frames with every field changed and their CRCs made
// right again, streams that do not end, registers at random. Nothing may be written beyond an image
// memory; and after a Reset, images and rays are taken as if nothing had been.
#include <array>
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "hal/crc32c.hpp"
#include "host/image/image_file.hpp"
#include "tests/rtl/shell_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::FrameType;
using protocol::SectionKind;

/// Records that each kind's memory holds, by kind (shell.cmake).
constexpr std::array<std::uint32_t, 6> kHolds{0, 4096, 6144, 8192, 4096, 2560};
constexpr std::size_t kLengthAt = 12;  ///< of a frame's header
constexpr std::uint32_t kIdleWindow = 0x1C0;
constexpr std::uint32_t kRegistersEnd = 0x240;

std::uint64_t schedules() {
  const char* text = std::getenv("GRIDRT_NOISE_SCHEDULES");
  return text == nullptr ? 12 : std::strtoull(text, nullptr, 10);
}

/// What a schedule has thrown, to know that it was something.
struct Thrown {
  std::uint64_t frames = 0, bytes = 0, records = 0, rays = 0, refusals = 0;
};

class Noise {
 public:
  Noise(std::uint64_t seed, const Image& image, Thrown& thrown)
      : random_(seed * 7919 + 3),
        bench_(static_cast<unsigned>(seed)),
        image_(image),
        thrown_(thrown) {
    const auto percent = [&] { return below(3) == 0 ? 20 + static_cast<int>(below(80)) : 100; };
    bench_.pace = {.rx = percent(), .tx = percent(), .ray = percent(), .hit = percent()};
    bench_.write(kIdleWindow, 500 + below(3000));
  }

  void make() {
    if (below(2) == 0) send_image(bench_, image_, 1, 512);
    for (std::uint32_t actions = 20 + below(60); actions > 0; --actions) {
      act();
      bench_.run(static_cast<int>(below(600)));
      look();
    }
  }

  /// A Reset, and a host in order finds a board in order.
  void recover() {
    bench_.reset_report();
    bench_.write(kIdleWindow, 4000);
    bench_.run_until_quiet(9000);
    look();
    bench_.from_device.clear();
    bench_.reset_report();
    bench_.pace = {};
    bench_.rays.clear();
    const std::uint32_t commit = send_image(bench_, image_, 1000);
    const auto rays = rays_in(image_, 60, 17);
    bench_.send(FrameType::kTrace, 5000, trace_payload(rays, 77), protocol::Layout::kCompact);
    bench_.run_until_quiet(1000);
    EXPECT_EQ(bench_.loads, records_of(image_));
    const std::vector<Answer> answers = take_answers(bench_);
    ASSERT_EQ(answers.size(), 2U);
    EXPECT_EQ(answers[0].type(), FrameType::kNoOp);
    EXPECT_EQ(answers[0].header.sequence, commit);
    EXPECT_EQ(answers[1].type(), FrameType::kHits);
    EXPECT_EQ(answers[1].payload, hits_payload(bench_, rays, 77));
  }

 private:
  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random_() % bound); }

  /// Values at the edges of what is checked, and any.
  std::uint32_t value() {
    constexpr std::array<std::uint32_t, 16> kEdges{
        0,       1,       3,       4,        7,         16,        0x7F,        0xFF,
        0x3FFFU, 0xA000U, 0xFFFFU, 0x10000U, 1U << 20U, 1U << 24U, 0x80000000U, ~0U};
    return below(3) == 0 ? static_cast<std::uint32_t>(random_()) : kEdges.at(below(16));
  }

  std::vector<std::byte> bytes(std::size_t count) {
    std::vector<std::byte> out(count);
    for (std::byte& b : out) b = static_cast<std::byte>(random_());
    return out;
  }

  /// All that has gone to the engine lies within its memories.
  void look() {
    for (const LoadedRecord& record : bench_.loads) {
      ASSERT_GE(record.kind, 1) << "a record of no kind";
      ASSERT_LT(record.kind, kHolds.size()) << "a record of no kind";
      EXPECT_LT(record.index, kHolds.at(record.kind)) << "a record beyond its memory";
      EXPECT_LT(record.pe, GRIDRT_RTL_PES) << "a record for no PE";
      const bool shared = record.kind <= static_cast<int>(SectionKind::kCells);
      EXPECT_TRUE(!shared || record.pe == 0) << "a shared record for one PE";
    }
    thrown_.records += bench_.loads.size();
    thrown_.rays += bench_.rays.size();
    bench_.loads.clear();
    bench_.rays.clear();
  }

  void send(std::span<const std::byte> frame) {
    ++thrown_.frames;
    thrown_.bytes += frame.size();
    bench_.send(frame);
  }

  void act() {
    switch (below(10)) {
      case 0:
        send(bytes(below(300)));
        break;
      case 1:
      case 2:
        send(lying_load());
        break;
      case 3:
        send(lying_section());
        break;
      case 4:
        send(frame_of(FrameType::kTrace, lying_trace()));
        break;
      case 5:
        send(frame_of(FrameType::kCommit, bytes(below(4) == 0 ? 4 * below(8) : 8)));
        break;
      case 6:
        send(frame_of(static_cast<FrameType>(below(12)), bytes(4 * below(64))));
        break;
      case 7: {  // a good header that promises more than comes
        auto frame = frame_of(static_cast<FrameType>(1 + below(5)), bytes(4 * below(32)));
        set_header_word(frame, kLengthAt, value());
        send(frame);
        break;
      }
      case 8:
        touch_register();
        break;
      default:
        commit_truly();
        break;
    }
  }

  /// A frame with a right CRC; now and then one field of its header is not as it should be.
  std::vector<std::byte> frame_of(FrameType type, std::span<const std::byte> payload) {
    std::vector<std::byte> frame;
    const auto layout = static_cast<protocol::Layout>(below(8) == 0 ? below(4) : 1);
    EXPECT_TRUE(append_frame(frame, type, type == FrameType::kTrace ? layout : protocol::Layout{},
                             value(), payload));
    switch (below(12)) {
      case 0: {
        const std::size_t at = below(16) / 4 * 4;
        set_header_word(frame, at, protocol::detail::get32(frame.data() + at) ^ (1U << below(32)));
        break;
      }
      case 1:
        frame.resize(below(static_cast<std::uint32_t>(frame.size())));
        break;
      case 2:
        frame[below(static_cast<std::uint32_t>(frame.size()))] ^=
            static_cast<std::byte>(1U << below(8));
        break;
      default:
        break;
    }
    return frame;
  }

  static void set_header_word(std::vector<std::byte>& frame, std::size_t at, std::uint32_t word) {
    protocol::detail::put32(frame.data() + at, word);
    protocol::detail::put32(frame.data() + 16, crc32c(std::span(frame).first(16)));
  }

  /// A piece of nothing, anywhere.
  std::vector<std::byte> lying_load() {
    const std::uint32_t count = below(200);
    protocol::LoadHead head;
    head.kind = static_cast<std::uint8_t>(below(6) == 0 ? value() : below(8));
    head.pe = static_cast<std::uint8_t>(below(6) == 0 ? value() : below(6));
    head.offset = below(2) == 0 ? 0 : value();
    head.total = below(2) == 0 ? count : value();
    head.bytes = below(4) == 0 ? value() : count;
    return frame_of(FrameType::kLoadSection, load_payload(head, bytes((count + 3) / 4 * 4)));
  }

  /// Bytes of a section: about as many as it has, about as many as fit the memory, up to twice
  /// that.
  std::uint32_t lying_size(const ImageSection& section) {
    constexpr std::array<std::uint32_t, 6> kStrides{0, 5, 4, 3, 7, 7};
    const auto kind = static_cast<std::size_t>(section.kind);
    if (kind >= kStrides.size()) return 0;
    const std::uint32_t most = kHolds.at(kind) * kStrides.at(kind);
    switch (below(4)) {
      case 0:
        return static_cast<std::uint32_t>(section.bytes.size()) + below(9);
      case 1:
        return most - 8 + below(24);
      case 2:
        return most + below(most);
      default:
        return below(most);
    }
  }

  /// A section of the image, of another length, or with bytes of it changed, its CRC in the header
  /// right or not: what the loader's own checks are for.
  std::vector<std::byte> lying_section() {
    Image image = image_;
    if (below(2) == 0) {
      auto& section = image.sections.at(below(static_cast<std::uint32_t>(image.sections.size())));
      if (below(3) != 0) section.bytes.resize(lying_size(section));
      for (std::uint32_t i = below(4); i > 0 && !section.bytes.empty(); --i) {
        section.bytes[below(static_cast<std::uint32_t>(section.bytes.size()))] =
            static_cast<std::byte>(random_());
      }
    }
    std::vector<std::byte> header = header_section(image);
    if (below(2) == 0) {
      protocol::detail::put32(
          header.data() + below(static_cast<std::uint32_t>(header.size() / 4)) * 4, value());
    }
    std::vector<std::byte> out;
    const auto add = [&](SectionKind kind, std::uint8_t pe, std::span<const std::byte> section) {
      for (std::size_t at = 0; at == 0 || at < section.size(); at += 2048) {
        const std::size_t count = std::min<std::size_t>(2048, section.size() - at);
        protocol::LoadHead head;
        head.kind = static_cast<std::uint8_t>(kind);
        head.pe = pe;
        head.offset = static_cast<std::uint32_t>(at);
        head.total = static_cast<std::uint32_t>(section.size());
        head.bytes = static_cast<std::uint32_t>(count);
        EXPECT_TRUE(append_frame(out, FrameType::kLoadSection, protocol::Layout::kNone, 7,
                                 load_payload(head, section.subspan(at, count))));
      }
    };
    add(SectionKind::kHeader, 0, header);
    for (const ImageSection& section : image.sections) {
      if (section.kind == SectionKind::kIds || section.kind == SectionKind::kScene) continue;
      if (below(8) != 0) add(section.kind, section.pe, section.bytes);
    }
    return out;
  }

  std::vector<std::byte> lying_trace() {
    auto payload =
        trace_payload(rays_in(image_, below(20), static_cast<unsigned>(random_())), value());
    if (below(3) == 0) protocol::detail::put32(payload.data(), value());
    if (below(3) == 0) payload.resize(4 * below(80));
    for (std::uint32_t i = below(3); i > 0 && !payload.empty(); --i) {
      payload[below(static_cast<std::uint32_t>(payload.size()))] =
          static_cast<std::byte>(random_());
    }
    return payload;
  }

  void commit_truly() {
    bench_.send(FrameType::kCommit, 9, commit_payload((1U << GRIDRT_RTL_PES) - 1U));
    ++thrown_.frames;
    if (below(2) == 0) return;
    send_image(bench_, image_, 11, 1024);
    for (std::uint32_t i = below(4); i > 0; --i) send(frame_of(FrameType::kTrace, lying_trace()));
    bench_.run_until_quiet(200);
  }

  void touch_register() {
    const std::uint32_t address = 4 * below(kRegistersEnd / 4);
    if (below(2) == 0) {
      bench_.read(address);
    } else if (address == kIdleWindow) {
      bench_.write(address, 1 + below(4000));
    } else {
      bench_.write(address, below(4) == 0 ? protocol::kResetKey : value());
    }
  }

  std::mt19937_64 random_;
  ShellBench bench_;
  const Image& image_;
  Thrown& thrown_;
};

TEST(ShellNoise, NothingIsWrittenBeyondAMemoryAndAResetMakesTheShellAsNew) {
  const Image image = small_image(12, GRIDRT_RTL_PES);
  Thrown thrown;
  for (std::uint64_t seed = 0; seed < schedules(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Noise noise(seed, image, thrown);
    noise.make();
    noise.recover();
    if (HasFailure()) break;
  }
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  std::printf("%llu schedules: %llu frames of %llu bytes, %llu records, %llu rays\n",
              number(schedules()), number(thrown.frames), number(thrown.bytes),
              number(thrown.records), number(thrown.rays));
  EXPECT_GT(thrown.records, 0U);
  EXPECT_GT(thrown.rays, 0U);
}

}  // namespace
}  // namespace gridrt::rtl
