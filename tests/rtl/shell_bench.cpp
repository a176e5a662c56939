#include "tests/rtl/shell_bench.hpp"

#include <algorithm>
#include <variant>

#include <gtest/gtest.h>

#include "host/image/image_file.hpp"
#include "host/scene/load.hpp"

namespace gridrt::rtl {
namespace {

using protocol::FrameType;
using protocol::SectionKind;

EngineHit made_up(const protocol::RayCompact& ray) {
  const std::uint32_t mixed = ray.p0[0] * 31 + ray.p1[1] * 17 + ray.p0[2] + ray.p1[2] + ray.ignore;
  if ((mixed & 3U) == 0) return {};
  return {true, ray.any_hit ? 0 : mixed & 0x3FFFFU};
}

/// Bits [at, at + width) of a port of several words, or of one.
template <class Words>
std::uint64_t bits(const Words& words, unsigned at, unsigned width) {
  std::uint64_t value = 0;
  for (unsigned i = 0; i < width; ++i) {
    value |= std::uint64_t{(words[(at + i) / 32] >> ((at + i) % 32)) & 1U} << i;
  }
  return value;
}

std::array<std::uint32_t, 3> three(std::uint64_t packed, unsigned width) {
  std::array<std::uint32_t, 3> out{};
  for (unsigned a = 0; a < 3; ++a) {
    out[a] = static_cast<std::uint32_t>(packed >> (a * width)) & ((1U << width) - 1U);
  }
  return out;
}

}  // namespace

ShellBench::ShellBench(unsigned seed)
    : engine(made_up), shell_(static_cast<int>(seed)), random_(seed) {
  shell_->rx_valid_i = 0;
  shell_->tx_ready_i = 0;
  shell_->reg_valid_i = 0;
  shell_->ray_ready_i = 0;
  shell_->hit_valid_i = 0;
  shell_->config_done_i = 0;
  shell_->counts_i = 0;
  for (int i = 0; i < 8; ++i) shell_->tap_i[i] = 0;
  shell_.reset();
}

bool ShellBench::chance(int percent) { return static_cast<int>(random_() % 100) < percent; }

protocol::RayCompact ShellBench::ray_at_port() {
  protocol::RayCompact ray;
  ray.p0 = three(shell_->ray_p0_o, GRIDRT_RTL_B);
  ray.p1 = three(shell_->ray_p1_o, GRIDRT_RTL_B);
  ray.ignore = shell_->ray_ignore_o;
  ray.any_hit = shell_->ray_any_o != 0;
  return ray;
}

void ShellBench::sample_load() {
  if (bits(shell_->load_o, 80, 1) == 0) return;
  LoadedRecord record;
  record.data = bits(shell_->load_o, 0, 56);
  record.index = static_cast<std::uint16_t>(bits(shell_->load_o, 56, 14));
  record.pe = static_cast<std::uint8_t>(bits(shell_->load_o, 70, 2));
  record.kind = static_cast<std::uint8_t>(bits(shell_->load_o, 72, 8));
  EXPECT_TRUE(flying_.empty()) << "a record while rays are in flight";
  loads.push_back(record);
}

void ShellBench::tick() {
  // Inputs; what has been offered stays.
  if (!rx_offered_) rx_offered_ = !to_device.empty() && chance(pace.rx);
  shell_->rx_valid_i = rx_offered_;
  shell_->rx_data_i = rx_offered_ ? static_cast<std::uint8_t>(to_device.front())
                                  : static_cast<std::uint8_t>(random_());
  shell_->tx_ready_i = chance(pace.tx);
  shell_->ray_ready_i = chance(pace.ray);
  if (!hit_offered_) {
    hit_offered_ = !flying_.empty() && flying_.front().due <= clocks() && chance(pace.hit);
  }
  shell_->hit_valid_i = hit_offered_;
  shell_->hit_i = hit_offered_ && flying_.front().hit.hit;
  shell_->hit_id_i =
      hit_offered_ ? flying_.front().hit.id : static_cast<std::uint32_t>(random_()) & 0xFFFFFU;
  shell_->config_done_i = config_left_ == 0;
  shell_->counts_i = counts;
  for (std::size_t i = 0; i < tap.size(); ++i) shell_->tap_i[i] = tap[i];
  shell_.settle();

  // Handshakes of this clock.
  if (tx_held_) {
    EXPECT_TRUE(shell_->tx_valid_o && shell_->tx_data_o == tx_byte_) << "an offered byte is gone";
  }
  tx_held_ = shell_->tx_valid_o && !shell_->tx_ready_i;
  tx_byte_ = shell_->tx_data_o;
  if (shell_->tx_valid_o && shell_->tx_ready_i) {
    from_device.push_back(static_cast<std::byte>(shell_->tx_data_o));
  }
  if (rx_offered_ && shell_->rx_ready_o) {
    to_device.pop_front();
    rx_offered_ = false;
  }
  if (hit_offered_ && shell_->hit_ready_o) {
    flying_.pop_front();
    hit_offered_ = false;
  }
  sample_load();
  if (shell_->ray_valid_o && shell_->ray_ready_i) {
    rays.push_back(ray_at_port());
    flying_.push_back({engine(rays.back()), clocks() + pace.latency});
  }
  if (config_left_ > 0) --config_left_;
  if (shell_->config_o) {
    EXPECT_TRUE(flying_.empty()) << "another grid while rays are in flight";
    ++configs;
    config_left_ = 25;
  }
  shell_.tick();
}

void ShellBench::run(int clocks) {
  for (int i = 0; i < clocks; ++i) tick();
}

void ShellBench::run_until_quiet(int clocks) {
  std::size_t seen = from_device.size();
  int quiet = 0;
  for (long i = 0; quiet < clocks; ++i) {
    ASSERT_LT(i, 20'000'000) << "the shell hangs";
    tick();
    quiet = to_device.empty() && flying_.empty() && from_device.size() == seen ? quiet + 1 : 0;
    seen = from_device.size();
  }
}

std::uint32_t ShellBench::read(std::uint32_t address) {
  shell_->reg_valid_i = 1;
  shell_->reg_write_i = 0;
  shell_->reg_address_i = static_cast<std::uint16_t>(address);
  shell_.settle();
  for (int i = 0; i < 1000 && !shell_->reg_ready_o; ++i) tick();
  EXPECT_TRUE(shell_->reg_ready_o) << "no register answers";
  const std::uint32_t data = shell_->reg_read_data_o;
  tick();
  shell_->reg_valid_i = 0;
  return data;
}

void ShellBench::write(std::uint32_t address, std::uint32_t data) {
  shell_->reg_valid_i = 1;
  shell_->reg_write_i = 1;
  shell_->reg_address_i = static_cast<std::uint16_t>(address);
  shell_->reg_write_data_i = data;
  shell_.settle();
  for (int i = 0; i < 100'000 && !shell_->reg_ready_o; ++i) tick();
  EXPECT_TRUE(shell_->reg_ready_o) << "no register answers";
  tick();
  shell_->reg_valid_i = 0;
}

protocol::StatusReport ShellBench::status() { return report<protocol::StatusReport>(0x0C0); }

void ShellBench::reset_report() { write(0x140, protocol::kResetKey); }

void ShellBench::send(std::span<const std::byte> bytes) {
  to_device.insert(to_device.end(), bytes.begin(), bytes.end());
}

void ShellBench::send(FrameType type, std::uint32_t sequence, std::span<const std::byte> payload,
                      protocol::Layout layout) {
  std::vector<std::byte> frame;
  ASSERT_TRUE(append_frame(frame, type, layout, sequence, payload));
  send(frame);
}

protocol::ErrorCode Answer::code() const {
  if (type() != FrameType::kError || payload.size() != 8) return protocol::ErrorCode::kNone;
  return static_cast<protocol::ErrorCode>(protocol::detail::get32(payload.data()));
}

std::uint32_t Answer::detail() const {
  return payload.size() != 8 ? 0 : protocol::detail::get32(payload.data() + 4);
}

std::vector<Answer> take_answers(ShellBench& bench, std::size_t* garbage) {
  std::vector<Answer> answers;
  FrameReader reader;
  reader.push(bench.from_device);
  std::size_t skipped = 0;
  for (;;) {
    const auto event = reader.next();
    if (!event) break;
    if (const auto* frame = std::get_if<Frame>(&*event)) {
      answers.push_back({frame->header, true, {frame->payload.begin(), frame->payload.end()}});
    } else {
      const auto& fault = std::get<FrameFault>(*event);
      answers.push_back({fault.header, false, {}});
      skipped += kFrameOverhead + fault.header.length;
    }
  }
  if (garbage != nullptr) {
    *garbage = reader.garbage_bytes() + reader.buffered();
  } else {
    EXPECT_EQ(reader.garbage_bytes() + reader.buffered(), skipped) << "bytes between the answers";
  }
  bench.from_device.clear();
  return answers;
}

std::uint32_t send_section(ShellBench& bench, SectionKind kind, std::uint8_t pe,
                           std::span<const std::byte> bytes, std::uint32_t sequence,
                           std::size_t piece) {
  for (const auto& payload : section_payloads(kind, pe, bytes, piece)) {
    bench.send(FrameType::kLoadSection, sequence++, payload);
  }
  return sequence;
}

std::uint32_t send_image(ShellBench& bench, const Image& image, std::uint32_t sequence,
                         std::size_t piece) {
  sequence = send_section(bench, SectionKind::kHeader, 0, header_section(image), sequence, piece);
  for (const ImageSection& section : image.sections) {
    if (section.kind == SectionKind::kIds || section.kind == SectionKind::kScene) continue;
    sequence = send_section(bench, section.kind, section.pe, section.bytes, sequence, piece);
  }
  bench.send(FrameType::kCommit, sequence, commit_payload((1U << image.header.pes) - 1U));
  return sequence;
}

std::vector<LoadedRecord> records_of(const Image& image) {
  std::vector<LoadedRecord> records;
  for (const ImageSection& section : image.sections) {
    if (section.kind == SectionKind::kIds || section.kind == SectionKind::kScene) continue;
    constexpr std::array<std::size_t, 6> kStrides{0, 5, 4, 3, 7, 7};
    const std::size_t stride = kStrides.at(static_cast<std::size_t>(section.kind));
    for (std::size_t i = 0; i < section.bytes.size() / stride; ++i) {
      LoadedRecord record;
      record.kind = static_cast<std::uint8_t>(section.kind);
      record.pe = section.pe;
      record.index = static_cast<std::uint16_t>(i);
      for (std::size_t b = 0; b < stride; ++b) {
        record.data |= static_cast<std::uint64_t>(section.bytes[i * stride + b]) << (8 * b);
      }
      records.push_back(record);
    }
  }
  return records;
}

Image small_image(int bits, int pes) {
  const auto scene = load_scene("builtin:teapot?tessellation=4");
  EXPECT_TRUE(scene) << scene.error().message;
  ImageOptions options;
  options.bits = bits;
  options.pes = pes;
  options.layout = protocol::Layout::kCompact;
  options.grid = glm::ivec3{13, 8, 7};
  const auto image = build_image(*scene, options);
  EXPECT_TRUE(image) << image.error().message;
  return *image;
}

std::vector<std::byte> hits_payload(const ShellBench& bench,
                                    std::span<const protocol::RayCompact> rays, std::uint32_t tag) {
  constexpr std::size_t kHit = protocol::HitCompact::kBytes;
  std::vector<std::byte> payload(protocol::TraceHead::kBytes + kHit * rays.size());
  protocol::store(protocol::TraceHead{static_cast<std::uint32_t>(rays.size()), tag},
                  std::span(payload).first<protocol::TraceHead::kBytes>());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const EngineHit hit = bench.engine(rays[i]);
    protocol::HitCompact record;
    record.id = hit.id;
    record.hit = hit.hit;
    protocol::pack(record, std::span(payload)
                               .subspan(protocol::TraceHead::kBytes + i * kHit)
                               .first<protocol::HitCompact::kBytes>());
  }
  return payload;
}

}  // namespace gridrt::rtl
