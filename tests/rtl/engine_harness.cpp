#include "tests/rtl/engine_harness.hpp"

#include <algorithm>
#include <random>
#include <string>

#include <Vgridrt_engine.h>
#include <verilated_syms.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/march_ports.hpp"

namespace gridrt::rtl {
namespace {

constexpr int kBits = GRIDRT_RTL_B;
constexpr int kLoadDataBits = 56;
constexpr std::size_t kWords = 3;  // of load_t

std::uint64_t packed(std::span<const std::uint32_t, 3> p) {
  return std::uint64_t{p[0]} | (std::uint64_t{p[1]} << kBits) |
         (std::uint64_t{p[2]} << (2 * kBits));
}

/// Fields of counts_t from bit 0.
void add(EngineCounts& sum, std::uint64_t counts) {
  const auto field = [&](int width) {
    const auto value = static_cast<long>(counts & ((1U << static_cast<unsigned>(width)) - 1U));
    counts >>= static_cast<unsigned>(width);
    return value;
  };
  sum.hit_wait += field(1);
  sum.divider_busy += field(3);
  sum.pe_idle += field(3);
  sum.queue_full += field(3);
  sum.traversal_idle += field(3);
  sum.no_slot += field(1);
  sum.no_ray += field(1);
  sum.in_flight += field(1);
  sum.feedback_waits += field(1);
  sum.interrupts += field(3);
  sum.masked += field(6);
  sum.tests += field(3);
  sum.steps += field(3);
  sum.rays += field(1);
}

std::size_t stride_of(const protocol::ImageHeader& header, protocol::SectionKind kind) {
  switch (kind) {
    case protocol::SectionKind::kBlocks:
      return protocol::BlockCodec(header).stride();
    case protocol::SectionKind::kCells:
      return protocol::CellCodec(header).stride();
    case protocol::SectionKind::kReferences:
      return protocol::ReferenceCodec(header).stride();
    case protocol::SectionKind::kTriangles:
      return protocol::TriangleCodec(header).stride();
    case protocol::SectionKind::kVertices:
      return protocol::VertexCodec(header).stride();
    default:
      return 0;  // not for the engine
  }
}

}  // namespace

class EngineHarness::Rtl : public Clocked<Vgridrt_engine> {
 public:
  using Clocked::Clocked;

  /// By PE, since the reset.
  std::vector<PeWork> pes() {
    std::vector<PeWork> out;
    while (true) {
      const std::string name =
          "TOP.gridrt_engine.u_pes.gen_pe[" + std::to_string(out.size()) + "].u_pe.u_pace";
      const VerilatedScope* scope = context().scopeFind(name.c_str());
      if (scope == nullptr) return out;
      const VerilatedVar* const tests = scope->varFind("tests");
      const VerilatedVar* const work = scope->varFind("work");
      if (tests == nullptr || work == nullptr) return {};
      const auto count = [](const VerilatedVar* of) {
        return static_cast<long>(*static_cast<const std::uint64_t*>(of->datap()));
      };
      out.push_back({count(tests), count(work)});
    }
  }
};

protocol::RayCompact engine_ray(const Segment& segment, std::uint32_t local_ignore, bool any_hit) {
  protocol::RayCompact ray;
  for (int a = 0; a < 3; ++a) {
    ray.p0[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(segment.p0[a]);
    ray.p1[static_cast<std::size_t>(a)] = static_cast<std::uint32_t>(segment.p1[a]);
  }
  ray.ignore = local_ignore & protocol::kNoIdCompact;
  ray.any_hit = any_hit;
  return ray;
}

EngineHarness::EngineHarness(int seed) : rtl_(std::make_unique<Rtl>(seed)) {
  Rtl& rtl = *rtl_;
  rtl->load_i[2] = 0;
  rtl->config_i = 0;
  rtl->ray_valid_i = 0;
  rtl->hit_ready_i = 0;
  rtl.reset();
}

EngineHarness::~EngineHarness() = default;

void EngineHarness::load(const Image& image) {
  Rtl& rtl = *rtl_;
  for (const ImageSection& section : image.sections) {
    const std::size_t stride = stride_of(image.header, section.kind);
    if (stride == 0) continue;
    for (std::size_t i = 0; (i + 1) * stride <= section.bytes.size(); ++i) {
      std::uint64_t record = 0;
      for (std::size_t b = 0; b < stride; ++b) {
        record |= std::to_integer<std::uint64_t>(section.bytes[i * stride + b]) << (8 * b);
      }
      for (std::size_t w = 0; w < kWords; ++w) rtl->load_i[w] = 0;
      march::Put put(rtl->load_i);
      put(static_cast<std::int64_t>(record), kLoadDataBits);
      put(static_cast<std::int64_t>(i), 14);
      put(section.pe, 2);
      put(static_cast<std::int64_t>(section.kind), 8);
      put(1, 1);
      rtl.tick();
    }
  }
  for (std::size_t w = 0; w < kWords; ++w) rtl->load_i[w] = 0;
  std::uint64_t edges = 0;
  std::uint32_t counts = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    counts |= static_cast<std::uint32_t>(image.header.grid_count[a]) << (10 * a);
    edges |= static_cast<std::uint64_t>(image.header.grid_edge[a]) << (18 * a);
  }
  rtl->grid_count_i = counts;
  rtl->grid_edge_i = edges;
  rtl->config_i = 1;
  rtl.tick();
  rtl->config_i = 0;
  for (int i = 0; i < 100; ++i) rtl.tick();
}

EngineAnswers EngineHarness::trace(std::span<const protocol::RayCompact> rays,
                                   const EngineRun& run) {
  Rtl& rtl = *rtl_;
  std::mt19937_64 random(run.seed);
  const auto chance = [&](int percent) {
    return percent >= 100 || static_cast<int>(random() % 100) < percent;
  };
  EngineAnswers out;
  out.hits.reserve(rays.size());
  std::size_t next = 0;
  bool offered = false;
  long begin = -1;
  long progress = rtl.clocks();
  const std::vector<PeWork> before = rtl.pes();
  while (out.hits.size() < rays.size() && rtl.clocks() - progress < run.patience) {
    if (!offered && next < rays.size() && chance(run.offer)) {
      const protocol::RayCompact& ray = rays[next];
      rtl->ray_p0_i = packed(ray.p0);
      rtl->ray_p1_i = packed(ray.p1);
      rtl->ray_ignore_i = ray.ignore;
      rtl->ray_any_i = static_cast<std::uint8_t>(ray.any_hit != 0);
      offered = true;
    }
    rtl->ray_valid_i = static_cast<std::uint8_t>(offered);
    rtl->hit_ready_i = static_cast<std::uint8_t>(chance(run.take));
    rtl.settle();
    if (offered && rtl->ray_ready_o != 0) {
      offered = false;
      ++next;
      progress = rtl.clocks();
      if (begin < 0) begin = rtl.clocks();
    }
    if (rtl->hit_valid_o != 0 && rtl->hit_ready_i != 0) {
      protocol::HitCompact hit;
      hit.id = rtl->hit_id_o;
      hit.hit = rtl->hit_o;
      out.hits.push_back(hit);
      progress = rtl.clocks();
    }
    rtl.tick();
    add(out.counts, rtl->counts_o);
  }
  out.clocks = rtl.clocks() - begin;
  rtl->ray_valid_i = 0;
  rtl->hit_ready_i = 0;
  for (int i = 0; i < 8; ++i) {
    rtl.tick();
    add(out.counts, rtl->counts_o);
  }
  out.pes = rtl.pes();
  for (std::size_t p = 0; p < before.size(); ++p) {
    out.pes[p].tests -= before[p].tests;
    out.pes[p].clocks -= before[p].clocks;
  }
  return out;
}

}  // namespace gridrt::rtl
