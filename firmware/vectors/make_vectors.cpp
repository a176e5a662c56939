// Makes the self-test's vectors: a small image, rays, and the answers of the reference device.
//
// usage: gridrt-self-test-vectors BITS PES OUTPUT.cpp
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "hal/frame.hpp"
#include "hal/record_sizes.hpp"
#include "host/image/image.hpp"
#include "host/image/image_frames.hpp"
#include "host/pe/capabilities.hpp"
#include "host/pe/software_device.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kTriangles = 24;
constexpr std::size_t kRays = 48;
constexpr std::uint32_t kTag = 0x54534554;  // TEST

/// Triangles strewn over the unit cube, so that every PE has some.
Scene strewn_triangles(std::mt19937& random) {
  const auto unit = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
  const auto point = [&] {
    const float x = unit();
    const float y = unit();
    return glm::vec3{x, y, unit()};
  };
  constexpr float kSize = 0.5F;
  Scene scene;
  scene.materials.emplace_back();
  for (std::size_t i = 0; i < kTriangles; ++i) {
    const auto base = static_cast<std::uint32_t>(scene.positions.size());
    const glm::vec3 corner = point();
    scene.positions.push_back(corner);
    for (int k = 0; k < 2; ++k) scene.positions.push_back(corner + kSize * (point() - 0.5F));
    scene.triangles.push_back({base, base + 1, base + 2});
    scene.triangle_materials.push_back(0);
  }
  return scene;
}

/// Rays across the lattice box; every other one aims at the middle of a triangle.
std::vector<protocol::RayCompact> rays_through(const Image& image, const ImageTriangles& triangles,
                                               std::mt19937& random) {
  std::vector<protocol::RayCompact> rays(kRays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    protocol::RayCompact& ray = rays[i];
    const LatticeTriangle& aim = triangles.triangles[i % triangles.triangles.size()];
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const auto box = static_cast<std::uint32_t>(image.header.max_q[axis]) + 2U;
      const auto middle = static_cast<std::uint32_t>((aim.v[0][a] + aim.v[1][a] + aim.v[2][a]) / 3);
      // As far behind the middle as before it, within the box.
      const std::uint32_t reach = std::min(middle, box - middle);
      const auto step = static_cast<std::uint32_t>(random() % (2 * reach + 1));
      ray.p0[axis] = middle - reach + step;
      ray.p1[axis] =
          i % 2 == 0 ? static_cast<std::uint32_t>(random() % (box + 1)) : middle + reach - step;
    }
    ray.ignore = i % 5 == 0 ? static_cast<std::uint32_t>(i % triangles.triangles.size())
                            : protocol::kNoIdCompact;
    ray.any_hit = i % 4 == 3 ? 1 : 0;
  }
  return rays;
}

Result<std::vector<std::byte>> trace_frame(std::span<const protocol::RayCompact> rays,
                                           std::uint32_t sequence) {
  std::vector<std::byte> frame;
  FrameBuilder builder(frame, protocol::FrameType::kTrace, protocol::Layout::kCompact, sequence);
  std::array<std::byte, protocol::TraceHead::kBytes> head{};
  protocol::store(protocol::TraceHead{static_cast<std::uint32_t>(rays.size()), kTag}, head);
  builder.append(head);
  for (const protocol::RayCompact& ray : rays) {
    std::array<std::byte, protocol::RayCompact::kBytes> record{};
    protocol::pack(ray, record);
    builder.append(record);
  }
  if (auto done = builder.finish(); !done) return std::unexpected(std::move(done.error()));
  return frame;
}

/// What the reference device answers to the frames. Errors besides its own: kInternal if it does
/// not take them all.
Result<std::vector<std::byte>> reference_answers(std::span<const std::byte> frames) {
  SoftwareDeviceOptions options;
  options.capabilities = board_capabilities();
  SoftwareDevice device(options);
  if (auto taken = device.consume(frames); !taken) return std::unexpected(taken.error());
  std::vector<std::byte> answers;
  std::array<std::byte, 4096> piece{};
  for (;;) {
    const auto got = device.produce(piece, std::chrono::milliseconds(1000));
    if (!got) return std::unexpected(got.error());
    if (*got == 0) break;
    answers.insert(answers.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(*got));
  }
  FrameReader reader;
  reader.push(answers);
  std::size_t hits = 0;
  while (const auto event = reader.next()) {
    const auto* frame = std::get_if<Frame>(&*event);
    if (frame == nullptr || frame->type() == protocol::FrameType::kError) {
      return fail(ErrorKind::kInternal, "the reference device refuses the self-test");
    }
    if (frame->type() != protocol::FrameType::kHits) continue;
    for (std::size_t at = protocol::TraceHead::kBytes; at < frame->payload.size();
         at += protocol::HitCompact::kBytes) {
      hits += protocol::unpack_hit_compact(
                  frame->payload.subspan(at).first<protocol::HitCompact::kBytes>())
                          .hit != 0
                  ? 1
                  : 0;
    }
  }
  // A test that could be passed by saying "miss" is none.
  if (hits < kRays / 4 || hits > 3 * kRays / 4) {
    return fail(ErrorKind::kInternal, std::to_string(hits) + " hits among the self-test's rays");
  }
  return answers;
}

std::string numbers(std::span<const std::byte> bytes, std::size_t size) {
  constexpr std::size_t kPerLine = 64;
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      value |= std::to_integer<std::uint32_t>(bytes[at + i]) << (8 * i);
    }
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.begin(), digits.end(), value, 16);
    out += "0x";
    out.append(digits.data(), static_cast<std::size_t>(end.ptr - digits.data()));
    out += at % kPerLine == kPerLine - size ? ",\n" : ",";
  }
  return out;
}

Result<std::string> make_source(int bits, int pes) {
  std::mt19937 random(2024);
  ImageOptions options;
  options.bits = bits;
  options.pes = pes;
  options.layout = protocol::Layout::kCompact;
  options.grid = glm::ivec3{4, 3, 4};
  options.with_scene = false;
  const auto image = build_image(strewn_triangles(random), options);
  if (!image) return std::unexpected(image.error());
  const auto triangles = decode_triangles(*image);
  if (!triangles) return std::unexpected(triangles.error());
  std::uint32_t sequence = 1;
  auto frames = image_frames(*image, board_capabilities().max_payload, sequence);
  if (!frames) return std::unexpected(frames.error());
  const auto trace = trace_frame(rays_through(*image, *triangles, random), sequence);
  if (!trace) return std::unexpected(trace.error());
  frames->insert(frames->end(), trace->begin(), trace->end());
  const auto answers = reference_answers(*frames);
  if (!answers) return std::unexpected(answers.error());
  std::string out =
      "// Made by firmware/vectors/make_vectors.cpp.\n"
      "#include \"firmware/self_test_vectors.hpp\"\n\nnamespace gridrt::firmware {\n\n"
      "namespace {\n\nconstexpr uint32_t kFrames[] = {\n";
  out += numbers(*frames, 4) + "};\n\nconstexpr uint8_t kAnswers[] = {\n" + numbers(*answers, 1);
  out += "};\n\n}  // namespace\n\nconst SelfTestVectors kSelfTestVectors = {kFrames, " +
         std::to_string(frames->size() / 4) + ", kAnswers, " + std::to_string(answers->size()) +
         ", " + std::to_string(kRays) + "};\n\n}  // namespace gridrt::firmware\n";
  return out;
}

int run(std::span<const char* const> arguments) {
  const auto number = [&](std::size_t i) {
    int value = 0;
    const std::string_view text = arguments[i];
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  };
  if (arguments.size() != 4) {
    std::fputs("usage: gridrt-self-test-vectors BITS PES OUTPUT.cpp\n", stderr);
    return 2;
  }
  const auto source = make_source(number(1), number(2));
  if (!source) {
    std::fprintf(stderr, "gridrt-self-test-vectors: %s\n", source.error().message.c_str());
    return 1;
  }
  std::FILE* file = std::fopen(arguments[3], "w");
  const bool written = file != nullptr && std::fputs(source->c_str(), file) >= 0;
  const bool closed = file != nullptr && std::fclose(file) == 0;
  return written && closed ? 0 : 1;
}

}  // namespace
}  // namespace gridrt

int main(int argc, char** argv) {
  return gridrt::run(std::span(const_cast<const char* const*>(argv),  // NOLINT: main's own type
                               static_cast<std::size_t>(argc)));
}
