// The host's driver against a device that lies. It ends with a typed error or with answers, in
// bounded virtual time; the answers are the truth if every frame was the honest device's, whatever
// happened to the reports and between the frames. Where a frame was forged, CRCs and all, a hit is
// still one that the ray meets.
#include "host/grid/intersect.hpp"
#include "tests/fuzz/fuzz_case.hpp"
#include "tests/fuzz/hostile_device.hpp"

namespace {

using gridrt::Hit;
using gridrt::Query;
using gridrt::Segment;
using gridrt::Session;
using gridrt::fuzz::Case;
using gridrt::fuzz::require;
using gridrt::protocol::Layout;

/// Above 64 attempts, each with the longest noise, and an hour of a device that is at work.
constexpr std::chrono::hours kMostTime(12);

bool meets(const Case& c, const Segment& segment, std::int32_t id) {
  const auto& ids = c.triangles.global_ids;
  const auto found = std::ranges::find(ids, static_cast<std::uint32_t>(id));
  if (found == ids.end()) return false;
  const auto at = static_cast<std::size_t>(found - ids.begin());
  return gridrt::intersect_exact(segment.p0, segment.p1, c.triangles.triangles[at]).has_value();
}

void check(const Case& c, Query query, const std::vector<Hit>& hits, bool forged) {
  const std::vector<Hit>& truth = query == Query::kAnyHit ? c.any : c.closest;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    if (!forged) require(gridrt::fuzz::same(hits[i], truth[i]));
    if (query == Query::kAnyHit) {
      require(hits[i].id == 0 || hits[i].id == -1);
    } else {
      require(hits[i].id == -1 || meets(c, c.segments[i], hits[i].id));
    }
  }
}

/// A whole run of the host; what it ends with.
gridrt::Result<void> run(const Case& c, std::unique_ptr<gridrt::Transport> cable,
                         const gridrt::fuzz::Heard& heard, unsigned wishes) {
  auto session = Session::open(std::move(cable), gridrt::fuzz::options());
  if (!session) return std::unexpected(session.error());
  if (auto loaded = (*session)->load(c.image); !loaded) return loaded;
  std::vector<Hit> hits(c.segments.size());
  for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
    if (query == Query::kAnyHit && (wishes & 1U) == 0) continue;
    auto traced = (*session)->trace(c.segments, query, hits);
    if (!traced) return traced;
    check(c, query, hits, heard.forged);
  }
  if ((wishes & 2U) != 0) {
    const auto told = (*session)->explain(c.image, c.segments[1]);
    if (!told) return std::unexpected(told.error());
  }
  const auto counters = (*session)->counters();
  return counters ? gridrt::Result<void>{} : std::unexpected(counters.error());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Case compact = gridrt::fuzz::make_case(Layout::kCompact);
  static const Case wide = gridrt::fuzz::make_case(Layout::kWide);
  gridrt::fuzz::Input input({data, size});
  const unsigned flags = input.byte();
  if ((flags & 0x60U) == 0x20U) input.repeat();
  if ((flags & 0x60U) == 0x40U) input.scatter();
  gridrt::fuzz::Heard heard;
  auto cable =
      std::make_unique<gridrt::fuzz::HostileDevice>(gridrt::fuzz::honest_device(), input, heard);
  if ((flags & 2U) != 0) cable->set_cut(1U + input.byte());
  const auto done = run((flags & 4U) != 0 ? compact : wide, std::move(cable), heard, flags >> 3U);
  require(done.has_value() || !done.error().message.empty());
  require(heard.now < kMostTime);
  return 0;
}
