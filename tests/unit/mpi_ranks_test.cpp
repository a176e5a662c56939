// Ranks as threads, with a postbox that loses what a test wants it to: no message may be lost
// without an error, and no rank may answer without its image.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "hal/loopback.hpp"
#include "hal/record_sizes.hpp"
#include "host/driver/session.hpp"
#include "host/mpi/rank_crew.hpp"
#include "host/mpi/rank_server.hpp"
#include "host/pe/software_device.hpp"
#include "tests/unit/pe_fixture.hpp"

namespace gridrt {
namespace {

using Filter = std::function<bool(const Parcel&, int from)>;  ///< false: the parcel is lost

/// The parcels of all ranks.
struct Office {
  explicit Office(int ranks) : boxes(static_cast<std::size_t>(ranks)) {}
  std::mutex mutex;
  std::vector<std::deque<Parcel>> boxes;
  Filter arrives;
};

class OfficeBox final : public Postbox {
 public:
  OfficeBox(Office& office, int rank) : office_(office), rank_(rank) {}
  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int ranks() const override { return static_cast<int>(office_.boxes.size()); }
  Result<void> send(Parcel parcel) override {
    const std::scoped_lock lock(office_.mutex);
    if (office_.arrives && !office_.arrives(parcel, rank_)) return {};
    auto& box = office_.boxes[static_cast<std::size_t>(parcel.peer)];
    parcel.peer = rank_;
    box.push_back(std::move(parcel));
    return {};
  }
  Result<std::optional<Parcel>> receive(int device) override {
    const std::scoped_lock lock(office_.mutex);
    auto& box = office_.boxes[static_cast<std::size_t>(rank_)];
    const auto first = std::ranges::find_if(
        box, [&](const Parcel& p) { return device == kAnyDevice || p.device == device; });
    if (first == box.end()) return std::nullopt;
    Parcel parcel = std::move(*first);
    box.erase(first);
    return parcel;
  }

 private:
  Office& office_;
  int rank_;
};

/// Ranks 1 and up serve on threads of their own.
class Team {
 public:
  Team(int ranks, Filter arrives, Schedule schedule = Schedule::kPes, bool interrupt = true,
       bool feedback = true)
      : office_(ranks) {
    office_.arrives = std::move(arrives);
    for (int r = 1; r < ranks; ++r) {
      threads_.emplace_back([this, r] {
        OfficeBox box(office_, r);
        EXPECT_TRUE(RankServer(box).serve());
      });
    }
    schedule_.schedule = schedule;
    schedule_.interrupt = interrupt;
    schedule_.feedback = feedback;
  }
  ~Team() {
    {
      const std::scoped_lock lock(office_.mutex);
      office_.arrives = nullptr;
    }
    OfficeBox box(office_, 0);
    for (int r = 1; r < box.ranks(); ++r) {
      EXPECT_TRUE(box.send({ParcelKind::kStop, r, kNoDevice, 0, {}}));
    }
  }

  /// `silence`: a busy machine may keep a rank waiting for long; those that lose messages have
  /// less.
  std::unique_ptr<Session> open(int number = 1, int groups = 1,
                                std::chrono::milliseconds silence = std::chrono::seconds(10)) {
    auto crew = std::make_unique<RankCrew>(std::make_unique<OfficeBox>(office_, 0), number,
                                           schedule_, software_capabilities(), silence, groups);
    SoftwareDeviceOptions device{.name = "mpi", .schedule = schedule_};
    return Session::open(std::make_unique<LoopbackTransport>(
                             std::make_unique<SoftwareDevice>(device, std::move(crew))),
                         {})
        .value();
  }

 private:
  Office office_;
  ScheduleOptions schedule_;
  std::vector<std::jthread> threads_;
};

std::vector<Hit> expected_hits(const Image& image, std::span<const Segment> segments, Query query) {
  DeviceOptions options;
  options.name = "seq";
  const auto device = open_device(options).value();
  EXPECT_TRUE(device->load(image));
  std::vector<Hit> hits(segments.size());
  EXPECT_TRUE(device->trace(segments, query, hits));
  return hits;
}

std::size_t differences(std::span<const Hit> a, std::span<const Hit> b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i) n += a[i].id != b[i].id ? 1 : 0;
  return n;
}

TEST(Ranks, AnswerLikeSeqInBothSchedulesWithSeveralDevicesOpen) {
  ImageOptions cut;
  cut.pes = 5;
  const Image image = fixture::make_image("builtin:teapot", cut);
  const auto segments = fixture::random_segments(image, 500, 3);
  for (const Schedule schedule : {Schedule::kPes, Schedule::kPaper}) {
    for (const int ranks : {1, 2, 3}) {
      Team team(ranks, nullptr, schedule);
      const auto one = team.open(1);
      const auto two = team.open(2);
      for (const auto* device : {&one, &two}) {
        ASSERT_TRUE((*device)->load(image));
        for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
          std::vector<Hit> hits(segments.size());
          ASSERT_TRUE((*device)->trace(segments, query, hits));
          EXPECT_EQ(differences(hits, expected_hits(image, segments, query)), 0U);
        }
      }
      const DeviceCounters counters = two->counters().value();
      EXPECT_EQ(counters.rays, one->counters().value().rays);
      EXPECT_EQ(counters.exchange.barriers, schedule == Schedule::kPaper ? counters.rays : 0);
    }
  }
}

TEST(Ranks, EachGetsTheSectionsOfItsOwnPesOnly) {
  ImageOptions cut;
  cut.pes = 5;
  const Image image = fixture::make_image("builtin:teapot", cut);
  std::atomic<int> wrong{0};
  std::atomic<int> own{0};
  Team team(3, [&](const Parcel& parcel, int) {
    if (parcel.kind == ParcelKind::kLoad) {
      const std::span<const std::byte> content(parcel.content);
      const auto head = protocol::load_load_head(content.first<protocol::LoadHead::kBytes>());
      if (head.kind > static_cast<std::uint8_t>(protocol::SectionKind::kCells)) {
        ++(head.pe % 3 == parcel.peer ? own : wrong);
      }
    }
    return true;
  });
  ASSERT_TRUE(team.open()->load(image));
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(own, 3 * 3);  // PEs 1, 2 and 4
}

TEST(Ranks, WithoutInterruptTheEighteenTeapotsTakeHalfAsManyTestsAgain) {
  const Image image = fixture::make_image("builtin:teapots");
  const auto segments = fixture::random_segments(image, 20000, 11);
  std::vector<Hit> hits(segments.size());
  std::uint64_t tests[2] = {0, 0};
  for (const bool interrupt : {true, false}) {
    Team team(4, nullptr, Schedule::kPes, interrupt);
    const auto device = team.open();
    ASSERT_TRUE(device->load(image));
    ASSERT_TRUE(device->trace(segments, Query::kClosestHit, hits));
    EXPECT_EQ(differences(hits, expected_hits(image, segments, Query::kClosestHit)), 0U);
    const DeviceCounters counters = device->counters().value();
    tests[interrupt ? 1 : 0] = counters.tests;
    EXPECT_EQ(counters.ahead.interrupts_sent > 0, interrupt);
  }
  EXPECT_GE(2 * tests[0], 3 * tests[1]);
}

TEST(Ranks, WithoutFeedbackAnswersAreWrong) {
  const Image image = fixture::make_image("builtin:teapots");
  const auto segments = fixture::random_segments(image, 20000, 13);
  const auto expected = expected_hits(image, segments, Query::kClosestHit);
  std::vector<Hit> hits(segments.size());
  for (const bool feedback : {true, false}) {
    Team team(4, nullptr, Schedule::kPes, true, feedback);
    const auto device = team.open();
    ASSERT_TRUE(device->load(image));
    ASSERT_TRUE(device->trace(segments, Query::kClosestHit, hits));
    EXPECT_EQ(differences(hits, expected) == 0, feedback);
  }
}

std::vector<PesRecord> records_in(const Parcel& parcel) {
  if (parcel.kind != ParcelKind::kRecords) return {};
  std::vector<PesRecord> records(parcel.content.size() / sizeof(PesRecord));
  std::memcpy(records.data(), parcel.content.data(), parcel.content.size());
  return records;
}

TEST(Ranks, HearOfTheEndOfABatchWhileTheHostIsAway) {
  const Image image = fixture::make_image("builtin:teapot");
  const auto segments = fixture::random_segments(image, 40, 17);
  std::atomic<std::size_t> told{0};
  Team team(2, [&](const Parcel& parcel, int) {
    for (const PesRecord& record : records_in(parcel)) {
      told += record.kind == PesKind::kDone ? 1 : 0;
    }
    return true;
  });
  const auto device = team.open();
  ASSERT_TRUE(device->load(image));
  std::size_t batches = 0;
  for (const Segment& segment : segments) {
    Hit hit;
    ASSERT_TRUE(device->trace({&segment, 1}, Query::kClosestHit, {&hit, 1}));
    if (!segment.is_miss()) ++batches;
    // Told by now: this thread is rank 0, and does nothing until the next batch.
    ASSERT_EQ(told, batches);
  }
  EXPECT_GT(batches, segments.size() / 2);
}

TEST(Ranks, InGroupsEachWithAllPesAndAPartOfTheRays) {
  ImageOptions cut;
  cut.pes = 3;
  const Image image = fixture::make_image("builtin:teapot", cut);
  const auto segments = fixture::random_segments(image, 500, 19);
  for (const Schedule schedule : {Schedule::kPes, Schedule::kPaper}) {
    for (const auto& [ranks, groups] : {std::pair(2, 2), {4, 2}, {6, 3}}) {
      const int size = ranks / groups;
      std::atomic<int> strays{0};  // records between groups
      std::mutex mutex;
      std::map<int, std::size_t> bytes;  // of rays, to each rank
      Team team(
          ranks,
          [&](const Parcel& parcel, int from) {
            const bool stray = from / size != parcel.peer / size;
            strays += stray && parcel.kind == ParcelKind::kRecords ? 1 : 0;
            const std::scoped_lock lock(mutex);
            if (parcel.kind == ParcelKind::kBatch) bytes[parcel.peer] += parcel.content.size();
            return true;
          },
          schedule);
      const auto device = team.open(1, groups);
      ASSERT_TRUE(device->load(image));
      for (const std::size_t count : {std::size_t{1}, segments.size()}) {
        const auto some = std::span(segments).first(count);
        for (const Query query : {Query::kClosestHit, Query::kAnyHit}) {
          std::vector<Hit> hits(count);
          ASSERT_TRUE(device->trace(some, query, hits));
          EXPECT_EQ(differences(hits, expected_hits(image, some, query)), 0U);
        }
      }
      EXPECT_EQ(strays, 0);
      const DeviceCounters counters = device->counters().value();
      EXPECT_EQ(counters.exchange.barriers, schedule == Schedule::kPaper ? counters.rays : 0);
      const std::size_t all = counters.rays * ray_record_bytes(protocol::Layout::kWide);
      const std::scoped_lock lock(mutex);
      EXPECT_NEAR(static_cast<double>(bytes[ranks - 1] * groups), static_cast<double>(all),
                  0.02 * static_cast<double>(all));
    }
  }
}

/// The error of a trace in which a filter loses parcels.
Error lossy(Schedule schedule, const Filter& arrives, int ranks = 3, int groups = 1) {
  const Image image = fixture::make_image("builtin:teapot");
  const auto segments = fixture::random_segments(image, 2000, 5);
  std::vector<Hit> hits(segments.size());
  Team team(ranks, arrives, schedule);
  const auto device = team.open(1, groups, std::chrono::milliseconds(400));
  if (auto loaded = device->load(image); !loaded) return loaded.error();
  const auto start = std::chrono::steady_clock::now();
  const auto traced = device->trace(segments, Query::kClosestHit, hits);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(8));
  EXPECT_FALSE(traced);
  if (traced) return {};
  // It stays failed.
  EXPECT_FALSE(device->trace(segments, Query::kClosestHit, hits));
  return traced.error();
}

/// True for records without which a ray has no answer; interrupts are no such.
bool is_needed(const Parcel& parcel) {
  return std::ranges::any_of(records_in(parcel), [](const PesRecord& record) {
    return record.kind == PesKind::kFeedback || record.kind == PesKind::kSettled;
  });
}

TEST(Ranks, ALostMessageIsAnError) {
  for (const Schedule schedule : {Schedule::kPes, Schedule::kPaper}) {
    std::atomic<int> records{0};
    const Error error = lossy(
        schedule, [&](const Parcel& parcel, int) { return !is_needed(parcel) || records++ != 3; });
    EXPECT_EQ(error.kind, ErrorKind::kDevice);
    EXPECT_NE(error.message.find("a message between ranks is lost"), std::string::npos)
        << error.message;
  }
}

TEST(Ranks, AnAnswerOfAGroupThatIsLostIsAnError) {
  const Error error = lossy(
      Schedule::kPes, [](const Parcel& parcel, int) { return parcel.kind != ParcelKind::kAnswer; },
      4, 2);
  EXPECT_EQ(error.kind, ErrorKind::kDevice);
  EXPECT_NE(error.message.find("silent"), std::string::npos) << error.message;
}

TEST(Ranks, ASilentRankIsAnError) {
  const Error error = lossy(Schedule::kPes, [](const Parcel& parcel, int from) {
    return from != 2 || (parcel.kind != ParcelKind::kRecords && parcel.kind != ParcelKind::kBeat);
  });
  EXPECT_EQ(error.kind, ErrorKind::kDevice);
  EXPECT_NE(error.message.find("rank 2 has been silent"), std::string::npos) << error.message;
}

TEST(Ranks, ARankThatDoesNotAnswerAnUploadIsAnError) {
  const Error error = lossy(Schedule::kPes, [](const Parcel& parcel, int from) {
    return from != 1 || parcel.kind != ParcelKind::kVerdict;
  });
  EXPECT_EQ(error.kind, ErrorKind::kDevice);
  EXPECT_NE(error.message.find("not answered"), std::string::npos) << error.message;
}

TEST(Ranks, ARankWithoutTheImageRefusesRays) {
  // It is told to forget the image when it has it.
  const Image image = fixture::make_image("builtin:teapot");
  const auto segments = fixture::random_segments(image, 100, 5);
  std::vector<Hit> hits(segments.size());
  Office office(2);
  std::jthread server([&] {
    OfficeBox box(office, 1);
    EXPECT_TRUE(RankServer(box).serve());
  });
  OfficeBox box(office, 0);
  {
    ScheduleOptions schedule;
    schedule.schedule = Schedule::kPes;
    auto crew = std::make_unique<RankCrew>(std::make_unique<OfficeBox>(office, 0), 1, schedule,
                                           software_capabilities(), std::chrono::milliseconds(400));
    const auto device =
        Session::open(
            std::make_unique<LoopbackTransport>(std::make_unique<SoftwareDevice>(
                SoftwareDeviceOptions{.name = "mpi", .schedule = schedule}, std::move(crew))),
            {})
            .value();
    ASSERT_TRUE(device->load(image));
    ASSERT_TRUE(box.send({ParcelKind::kReset, 1, 1, 0, {}}));
    const auto traced = device->trace(segments, Query::kClosestHit, hits);
    ASSERT_FALSE(traced);
    EXPECT_EQ(traced.error().kind, ErrorKind::kDevice);
    EXPECT_NE(traced.error().message.find("NotReady (detail 1)"), std::string::npos)
        << traced.error().message;
  }
  ASSERT_TRUE(box.send({ParcelKind::kStop, 1, kNoDevice, 0, {}}));
}

}  // namespace
}  // namespace gridrt
