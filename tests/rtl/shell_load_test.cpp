// Images through gridrt_shell: what reaches the engine's memories, and what is refused.
#include <map>

#include <gtest/gtest.h>

#include "hal/crc32c.hpp"
#include "host/image/image_file.hpp"
#include "tests/rtl/shell_bench.hpp"

namespace gridrt::rtl {
namespace {

using protocol::DeviceState;
using protocol::ErrorCode;
using protocol::FrameType;
using protocol::SectionKind;

/// The only answer there is.
Answer only_answer(ShellBench& bench) {
  bench.run_until_quiet();
  const std::vector<Answer> answers = take_answers(bench);
  EXPECT_EQ(answers.size(), 1U);
  return answers.empty() ? Answer{} : answers.front();
}

void expect_loaded(ShellBench& bench, const Image& image, std::uint32_t commit) {
  const Answer answer = only_answer(bench);
  EXPECT_EQ(answer.type(), FrameType::kNoOp)
      << protocol::name(answer.code()) << " " << answer.detail();
  EXPECT_EQ(answer.header.sequence, commit);
  EXPECT_EQ(bench.status().state, static_cast<int>(DeviceState::kReady));
  const protocol::ImageHeader& h = image.header;
  for (unsigned a = 0; a < 3; ++a) {
    EXPECT_EQ(bench.ports().grid_count_o >> (10 * a) & 0x3FFU,
              static_cast<unsigned>(h.grid_count[a]));
    EXPECT_EQ(bench.ports().grid_edge_o >> (18 * a) & 0x3FFFFU,
              static_cast<unsigned>(h.grid_edge[a]));
  }
}

class ShellLoad : public testing::TestWithParam<int> {};

TEST_P(ShellLoad, EveryRecordReachesItsMemory) {
  if (GetParam() > GRIDRT_RTL_B) GTEST_SKIP();
  const Image image = small_image(GetParam());
  for (const std::size_t piece : {4U, 52U, 4096U, 16368U}) {
    ShellBench bench(static_cast<unsigned>(piece));
    if (piece == 52) bench.pace = {.rx = 40, .tx = 30};
    const std::uint32_t commit = send_image(bench, image, 100, piece);
    expect_loaded(bench, image, commit);
    EXPECT_EQ(bench.loads, records_of(image));
    EXPECT_EQ(bench.configs, 1);
  }
}

INSTANTIATE_TEST_SUITE_P(Bits, ShellLoad, testing::Values(6, 12, 14, 17),
                         [](const auto& bits) { return std::to_string(bits.param); });

TEST(ShellLoad, SmallerImagesAndMoreThanOne) {
  ShellBench bench;
  std::uint32_t sequence = 1;
  for (const int pes : {1, 2, 3, 4, 2}) {
    if (pes > GRIDRT_RTL_PES) continue;
    bench.loads.clear();
    const Image image = small_image(12, pes);
    sequence = send_image(bench, image, sequence + 1);
    expect_loaded(bench, image, sequence);
    EXPECT_EQ(bench.loads, records_of(image));
    // Once more the whole of it, but without a header: nothing changes.
    bench.loads.clear();
    for (const ImageSection& section : image.sections) {
      if (section.kind == SectionKind::kIds || section.kind == SectionKind::kScene) continue;
      sequence = send_section(bench, section.kind, section.pe, section.bytes, sequence);
    }
    bench.send(FrameType::kCommit, ++sequence, commit_payload((1U << pes) - 1U));
    expect_loaded(bench, image, sequence);
    EXPECT_TRUE(bench.loads.empty());
  }
}

TEST(ShellLoad, LostAndDamagedPiecesAreAskedForAndTakenLater) {
  const Image image = small_image(12, GRIDRT_RTL_PES);
  std::mt19937 source(5);
  const auto random = [&] { return static_cast<std::uint32_t>(source()); };
  for (unsigned round = 0; round < 40; ++round) {
    ShellBench bench(round);
    std::uint32_t sequence = send_section(bench, SectionKind::kHeader, 0, header_section(image), 1);
    std::map<std::pair<int, int>, const ImageSection*> sections;
    for (const ImageSection& section : image.sections) {
      if (section.kind == SectionKind::kIds || section.kind == SectionKind::kScene) continue;
      sections[{static_cast<int>(section.kind), section.pe}] = &section;
      // Damage: a piece is lost, or a byte of it is wrong, or it comes twice.
      ShellBench& to = bench;
      const std::size_t before = to.to_device.size();
      sequence = send_section(to, section.kind, section.pe, section.bytes, sequence, 1024);
      const std::size_t bytes = to.to_device.size() - before;
      const auto at = to.to_device.begin() + static_cast<std::ptrdiff_t>(before);
      const std::size_t frame = std::min(bytes, 1024 + 16 + kFrameOverhead);
      switch (random() % 6) {
        case 0:
          to.to_device.erase(at, at + static_cast<std::ptrdiff_t>(frame));
          break;
        case 1:
          *(at + 20 + random() % (bytes - 24)) ^= std::byte{0x10};
          break;
        case 2:
        case 3: {
          std::vector<std::byte> again(at, at + static_cast<std::ptrdiff_t>(frame));
          // A late copy that is damaged has overwritten good records.
          if (random() % 2 == 0) again[40] ^= std::byte{0x20};
          bench.send(again);
          break;
        }
        default:
          break;
      }
    }
    for (int attempt = 0;; ++attempt) {
      ASSERT_LT(attempt, 20);
      bench.send(FrameType::kCommit, ++sequence, commit_payload((1U << GRIDRT_RTL_PES) - 1U));
      bench.write(0x1C0, 5000);  // a frame that was cut short
      bench.run_until_quiet(6000);
      const std::vector<Answer> answers = take_answers(bench);
      ASSERT_FALSE(answers.empty());
      const Answer& last = answers.back();
      ASSERT_EQ(last.header.sequence, sequence);
      if (last.type() == FrameType::kNoOp) break;
      // A bad frame has been dropped, so no section can have a wrong CRC.
      ASSERT_EQ(last.code(), ErrorCode::kMissingSection) << protocol::name(last.code());
      const auto missing = sections.find(
          {static_cast<int>(last.detail() & 0xFFU), static_cast<int>(last.detail() >> 8U)});
      ASSERT_NE(missing, sections.end()) << last.detail();
      const ImageSection& section = *missing->second;
      sequence = send_section(bench, section.kind, section.pe, section.bytes, sequence + 1, 1024);
    }
    // The memories hold what they should, whatever came in between.
    std::map<std::tuple<int, int, int>, std::uint64_t> memory;
    for (const LoadedRecord& r : bench.loads) memory[{r.kind, r.pe, r.index}] = r.data;
    for (const LoadedRecord& r : records_of(image)) {
      ASSERT_EQ((memory[{r.kind, r.pe, r.index}]), r.data) << "round " << round;
    }
  }
}

/// Sends the image after `change` has been at it; the answer to Commit.
template <class Change>
Answer refused(Change&& change) {
  Image image = small_image(12, GRIDRT_RTL_PES);
  change(image);
  ShellBench bench;
  const std::uint32_t commit = send_image(bench, image, 1);
  bench.run_until_quiet();
  const std::vector<Answer> answers = take_answers(bench);
  EXPECT_FALSE(answers.empty());
  EXPECT_EQ(answers.back().header.sequence, commit);
  EXPECT_EQ(answers.back().type(), FrameType::kError);
  const auto status = bench.status();
  EXPECT_EQ(status.state, static_cast<int>(DeviceState::kFailed));
  EXPECT_EQ(status.last_error, static_cast<int>(answers.back().code()));
  EXPECT_EQ(status.error_detail, answers.back().detail());
  EXPECT_EQ(bench.configs, 0);
  // Rays are refused, and a good image is taken.
  const Image good = small_image(12, GRIDRT_RTL_PES);
  bench.send(FrameType::kTrace, 7, trace_payload(rays_in(good, 3, 1), 7),
             protocol::Layout::kCompact);
  EXPECT_EQ(only_answer(bench).code(), ErrorCode::kNotReady);
  expect_loaded(bench, good, send_image(bench, good, 200));
  return answers.back();
}

#define EXPECT_REFUSED(answer, expected_code, expected_detail)                     \
  do {                                                                             \
    const Answer got = (answer);                                                   \
    EXPECT_EQ(got.code(), ErrorCode::expected_code) << protocol::name(got.code()); \
    EXPECT_EQ(got.detail(), static_cast<std::uint32_t>(expected_detail));          \
  } while (false)

TEST(ShellLoad, HeadersThatAreNotValidAreRefused) {
  using Header = protocol::ImageHeader;
  const auto header = [](auto&& set) { return refused([&](Image& image) { set(image.header); }); };
  EXPECT_REFUSED(header([](Header& h) { h.magic ^= 1; }), kBadHeader, 0);
  EXPECT_REFUSED(header([](Header& h) { ++h.version; }), kBadHeader, 4);
  EXPECT_REFUSED(header([](Header& h) { h.layout = 2; }), kBadHeader, 6);
  EXPECT_REFUSED(header([](Header& h) { h.pes = 0; }), kBadHeader, 7);
  EXPECT_REFUSED(header([](Header& h) { h.pes = GRIDRT_RTL_PES + 1; }), kBadHeader, 7);
  EXPECT_REFUSED(header([](Header& h) { h.bits = 3; }), kBadHeader, 8);
  EXPECT_REFUSED(header([](Header& h) { h.bits = GRIDRT_RTL_B + 1; }), kBadHeader, 8);
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    EXPECT_REFUSED(header([&](Header& h) { h.max_q[i] = 4094; }), kBadHeader, 52 + 4 * a);
    EXPECT_REFUSED(header([&](Header& h) { h.max_q[i] = 1; }), kBadHeader, 52 + 4 * a);
    EXPECT_REFUSED(header([&](Header& h) { h.max_q[i] = -5; }), kBadHeader, 52 + 4 * a);
    EXPECT_REFUSED(header([&](Header& h) { h.grid_count[i] = 0; }), kBadHeader, 64 + 4 * a);
    EXPECT_REFUSED(header([&](Header& h) { h.grid_count[i] = 513; }), kBadHeader, 64 + 4 * a);
    EXPECT_REFUSED(header([&](Header& h) { h.grid_edge[i] = 0; }), kBadHeader, 76 + 4 * a);
    EXPECT_REFUSED(header([&](Header& h) { h.grid_edge[i] = 1 << 20; }), kBadHeader, 76 + 4 * a);
    // A grid that does not reach the end of the box.
    EXPECT_REFUSED(header([&](Header& h) { h.grid_edge[i] = h.max_q[i] / h.grid_count[i]; }),
                   kBadHeader, 76 + 4 * a);
  }
  EXPECT_REFUSED(header([](Header& h) { h.margin = 1025; }), kBadHeader, 88);
  EXPECT_REFUSED(header([](Header& h) { h.local_ids = 1 << 20; }), kBadHeader, 100);
  EXPECT_REFUSED(header([](Header& h) { h.id_bits = 21; }), kBadHeader, 104);
  EXPECT_REFUSED(header([](Header& h) { h.pe_bits = 3; }), kBadHeader, 108);
  EXPECT_REFUSED(header([](Header& h) { h.occupied_cells = 1U << 30U; }), kBadHeader, 112);
  EXPECT_REFUSED(header([](Header& h) { ++h.occupied_cells; }), kBadSection, 2);
  EXPECT_REFUSED(header([](Header& h) { h.grid_count[1] += 2; }), kBadSection, 1);
}

TEST(ShellLoad, SectionsThatDoNotFitTheirHeaderAreRefused) {
  const auto section = [](SectionKind kind, int pe, auto&& change) {
    return refused([&](Image& image) {
      for (ImageSection& s : image.sections) {
        if (s.kind == kind && s.pe == pe) change(s);
      }
    });
  };
  const auto resized = [&](SectionKind kind, int pe, std::size_t bytes) {
    return section(kind, pe, [&](ImageSection& s) { s.bytes.resize(bytes); });
  };
  // One record more than the memory holds; not whole records; too few.
  EXPECT_REFUSED(resized(SectionKind::kBlocks, 0, 5 * 4096 + 5), kTooLarge, 1);
  EXPECT_REFUSED(resized(SectionKind::kCells, 0, 4 * 6144 + 4), kTooLarge, 2);
  EXPECT_REFUSED(resized(SectionKind::kReferences, 1, 3 * 8192 + 3), kTooLarge, 0x103);
  EXPECT_REFUSED(resized(SectionKind::kTriangles, 2, 7 * 4096 + 7), kTooLarge, 0x204);
  EXPECT_REFUSED(resized(SectionKind::kVertices, 3, 7 * 2560 + 7), kTooLarge, 0x305);
  EXPECT_REFUSED(resized(SectionKind::kVertices, 3, 7 * 2560 - 1), kBadSection, 0x305);
  EXPECT_REFUSED(resized(SectionKind::kBlocks, 0, 5 * 5), kBadSection, 1);
  EXPECT_REFUSED(resized(SectionKind::kCells, 0, 4), kBadSection, 2);
  // Fewer triangles than the references name.
  EXPECT_REFUSED(resized(SectionKind::kTriangles, 1, 7), kBadSection, 0x103);
  EXPECT_REFUSED(resized(SectionKind::kVertices, 2, 7 * 3), kBadSection, 0x204);
  EXPECT_REFUSED(resized(SectionKind::kReferences, 3, 3), kBadSection, 0x303);
  const auto filled = [&](SectionKind kind, int pe, int value) {
    return section(kind, pe, [&](ImageSection& s) {
      for (std::byte& b : s.bytes) b = static_cast<std::byte>(value);
    });
  };
  EXPECT_REFUSED(filled(SectionKind::kBlocks, 0, 0xFF), kBadSection, 1);
  EXPECT_REFUSED(filled(SectionKind::kCells, 0, 0), kBadSection, 2);
  EXPECT_REFUSED(filled(SectionKind::kCells, 0, 0xFF), kBadSection, 0x303);
  EXPECT_REFUSED(filled(SectionKind::kReferences, 0, 0xFF), kBadSection, 0x003);
  EXPECT_REFUSED(filled(SectionKind::kTriangles, 1, 0xFF), kBadSection, 0x104);
  EXPECT_REFUSED(filled(SectionKind::kVertices, 2, 0xFF), kBadSection, 0x205);
  // Twice in the directory, of a PE that there is not, or not at all.
  const int entry = 144;
  EXPECT_REFUSED(refused([](Image& image) { image.sections[1] = image.sections[0]; }), kBadHeader,
                 entry + 16);
  EXPECT_REFUSED(refused([](Image& image) { image.sections[1].pe = 1; }), kBadHeader, entry + 16);
  EXPECT_REFUSED(refused([](Image& image) {
                   std::erase_if(image.sections, [](const auto& s) {
                     return s.kind == SectionKind::kVertices && s.pe == 1;
                   });
                 }),
                 kBadHeader, 0x105);
}

}  // namespace
}  // namespace gridrt::rtl
