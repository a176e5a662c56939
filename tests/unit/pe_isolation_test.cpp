// A PE sees its own image and nothing else: every other section is unmapped while it works.
#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "host/grid/intersect.hpp"
#include "host/pe/engine.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

/// Bytes in pages of their own, which can be taken away and given back.
class Pages {
 public:
  explicit Pages(std::span<const std::byte> bytes) : bytes_(bytes.size()) {
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    length_ = (bytes.size() / page + 1) * page;
    address_ = mmap(nullptr, length_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (address_ == MAP_FAILED) throw std::bad_alloc();
    std::memcpy(address_, bytes.data(), bytes.size());
  }
  Pages(const Pages&) = delete;
  Pages& operator=(const Pages&) = delete;
  ~Pages() { munmap(address_, length_); }

  void take_away() { ASSERT_EQ(mprotect(address_, length_, PROT_NONE), 0); }
  void give_back() { ASSERT_EQ(mprotect(address_, length_, PROT_READ), 0); }
  [[nodiscard]] std::span<const std::byte> bytes() const {
    return {static_cast<const std::byte*>(address_), bytes_};
  }

 private:
  void* address_ = nullptr;
  std::size_t length_ = 0;
  std::size_t bytes_;
};

/// Partial answers of one PE to all rays: what it decodes, traverses and tests by itself.
std::vector<PeAnswer> run_alone(const protocol::ImageHeader& header, std::uint8_t pe,
                                const Pages& blocks, const Pages& cells, const Pages& references,
                                const Pages& triangles, const Pages& vertices,
                                std::span<const Segment> segments) {
  Accepted<TraversalMemory> traversal =
      TraversalMemory::decode(header, blocks.bytes(), cells.bytes());
  Accepted<Pe> decoded =
      Pe::decode(header, pe, references.bytes(), triangles.bytes(), vertices.bytes());
  EXPECT_TRUE(traversal.has_value() && decoded.has_value());
  std::vector<std::optional<Pe>> pes(header.pes);
  pes[pe] = std::move(*decoded);
  const Accepted<Engine> engine = Engine::assemble(std::move(*traversal), std::move(pes));
  EXPECT_TRUE(engine.has_value());
  PeCounters counters;
  std::vector<PeAnswer> answers;
  for (const Segment& s : segments) {
    answers.push_back(s.is_miss() ? PeAnswer{}
                                  : engine->closest_hit({s.p0, s.p1, kNoTriangle}, counters));
  }
  return answers;
}

struct PePages {
  std::unique_ptr<Pages> references;
  std::unique_ptr<Pages> triangles;
  std::unique_ptr<Pages> vertices;

  void take_away() {
    for (Pages* p : {references.get(), triangles.get(), vertices.get()}) p->take_away();
  }
  void give_back() {
    for (Pages* p : {references.get(), triangles.get(), vertices.get()}) p->give_back();
  }
};

TEST(PeIsolation, EachPeAnswersAloneWithAllOtherSectionsUnmapped) {
  using protocol::SectionKind;
  ImageOptions options;
  options.pes = 4;
  const Image image = fixture::make_image("builtin:teapot?tessellation=6", options);
  const std::vector<Segment> segments = fixture::random_segments(image, 2000, 7);

  const Pages blocks(image.find(SectionKind::kBlocks)->bytes);
  const Pages cells(image.find(SectionKind::kCells)->bytes);
  std::vector<PePages> pages(image.header.pes);
  for (int p = 0; p < image.header.pes; ++p) {
    pages[static_cast<std::size_t>(p)] = {
        std::make_unique<Pages>(image.find(SectionKind::kReferences, p)->bytes),
        std::make_unique<Pages>(image.find(SectionKind::kTriangles, p)->bytes),
        std::make_unique<Pages>(image.find(SectionKind::kVertices, p)->bytes)};
  }
  const auto run = [&](std::size_t p) {
    return run_alone(image.header, static_cast<std::uint8_t>(p), blocks, cells,
                     *pages[p].references, *pages[p].triangles, *pages[p].vertices, segments);
  };
  std::vector<std::vector<PeAnswer>> alone;
  for (std::size_t p = 0; p < pages.size(); ++p) {
    const std::vector<PeAnswer> mapped = run(p);
    for (std::size_t other = 0; other < pages.size(); ++other) {
      if (other != p) pages[other].take_away();
    }
    alone.push_back(run(p));
    for (PePages& other : pages) other.give_back();
    EXPECT_EQ(alone.back(), mapped) << "PE " << p;
    EXPECT_GT(std::ranges::count_if(mapped, [](const PeAnswer& a) { return a.has_value(); }), 0)
        << "PE " << p << " has no hit: the test shows nothing";
  }

  // The smallest key over the PEs alone is the answer of all triangles.
  const Result<ImageTriangles> triangles = decode_triangles(image);
  ASSERT_TRUE(triangles.has_value());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    HitKey brute;
    for (std::uint32_t t = 0; t < triangles->triangles.size(); ++t) {
      const auto hit = intersect_exact(segments[i].p0, segments[i].p1, triangles->triangles[t]);
      if (hit) brute = std::min(brute, HitKey{hit_quotient(*hit), t});
    }
    HitKey merged;
    for (const auto& answers : alone) {
      if (answers[i]) merged = std::min(merged, *answers[i]);
    }
    ASSERT_EQ(merged, brute) << "ray " << i;
  }
}

}  // namespace
}  // namespace gridrt
