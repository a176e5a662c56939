// gridrt_traverse against the model, bit for bit: the block of each step, the voxels that leave,
// and in which of their cells the ray is; many rays at once, with random stalls and limits.
#include <array>
#include <bit>
#include <deque>
#include <optional>
#include <vector>

#include <Vgridrt_traverse.h>
#include <gtest/gtest.h>

#include "tests/rtl/clocked.hpp"
#include "tests/rtl/march_blocks.hpp"
#include "tests/rtl/march_ports.hpp"

namespace gridrt::march {
namespace {

constexpr int kUnits = 4;  // the unit under test is the first one: its slots are multiples of this
constexpr std::size_t kSlots = 16;
constexpr std::int64_t kNoLimit = std::int64_t{1} << 40;

/// A ray in a slot.
struct Ray {
  Segment segment;
  State state;
  std::int64_t limit = kNoLimit;
  bool busy = false;
};

/// What the unit sends for a step, from bit 0 of bundle_t on.
struct Bundle {
  std::int64_t far_enter = 0;
  std::int64_t near_enter = 0;
  std::array<std::array<unsigned, kFaces>, 2> sample{};
  unsigned holds = 0;
  unsigned axis = 0;
  unsigned front = 0;
  unsigned cand = 0;
  unsigned occ = 0;
  std::int64_t base = 0;
  std::size_t slot = 0;
};

template <class Wide>
Bundle get_bundle(const Wide& wide) {
  Get<Wide> get(wide);
  Bundle b;
  b.far_enter = get(18);
  b.near_enter = get(18);
  for (auto& axis : b.sample) {
    for (unsigned& s : axis) s = static_cast<unsigned>(get(4));
  }
  b.holds = static_cast<unsigned>(get(8));
  b.axis = static_cast<unsigned>(get(2));
  b.front = static_cast<unsigned>(get(8));
  b.cand = static_cast<unsigned>(get(8));
  b.occ = static_cast<unsigned>(get(8));
  b.base = get(13);
  b.slot = static_cast<std::size_t>(get(6));
  return b;
}

/// Cells of a voxel (bits x + 4 y + 16 z) that the way through the block names.
std::uint64_t cells_of(const Bundle& b, unsigned voxel) {
  const std::array<unsigned, 3> axes{b.axis, (b.axis + 1) % 3, (b.axis + 2) % 3};
  std::uint64_t cells = 0;
  for (unsigned slab = 0; slab < 8; ++slab) {
    if (((b.holds >> slab) & 1U) == 0 || slab / 4 != ((voxel >> axes[0]) & 1U)) continue;
    for (const unsigned qb : {b.sample[0][slab], b.sample[0][slab + 1]}) {
      for (const unsigned qc : {b.sample[1][slab], b.sample[1][slab + 1]}) {
        if (qb / 4 != ((voxel >> axes[1]) & 1U) || qc / 4 != ((voxel >> axes[2]) & 1U)) continue;
        cells |= std::uint64_t{1} << (((slab % 4) << (2 * axes[0])) + ((qb % 4) << (2 * axes[1])) +
                                      ((qc % 4) << (2 * axes[2])));
      }
    }
  }
  return cells;
}

class Traverse : public testing::Test {
 protected:
  void start(const Case& c, double density);
  void run(int rays, int offer, int take);

  [[nodiscard]] long steps() const { return steps_; }
  [[nodiscard]] int longest_jump() const { return longest_jump_; }

 private:
  void begin_rays(int& left, int offer);
  void check_step();
  void check_bundle();

  rtl::Clocked<Vgridrt_traverse> rtl_;
  Random random_{9};
  Case case_;
  Grid grid_;
  std::vector<Block> blocks_;
  std::array<Ray, kSlots> rays_;
  std::optional<std::size_t> next_;  ///< slot that waits to start
  bool limit_told_ = false;
  std::deque<std::pair<std::size_t, Step>> sent_;
  long steps_ = 0;
  int longest_jump_ = 0;
};

void Traverse::start(const Case& c, double density) {
  case_ = c;
  grid_ = make_march_grid(c.grid);
  blocks_ = random_blocks(random_, grid_, density);
  rtl_->start_valid_i = 0;
  rtl_->bundle_ready_i = 0;
  rtl_->interrupt_i = 0;
  rtl_->alloc_i = 0;
  rtl_->few_i = 0;
  rtl_->idle_i = 0;
  rtl_.reset();
  put_grid(rtl_->grid_i, grid_);
}

/// A slot is given to a ray, then it may get a limit, then it starts.
void Traverse::begin_rays(int& left, int offer) {
  rtl_->alloc_i = 0;
  rtl_->interrupt_i = 0;
  rtl_->start_valid_i = 0;
  if (!next_ && left > 0 && random_.between(0, 99) < offer) {
    const auto slot = static_cast<std::size_t>(random_.below(kSlots));
    if (rays_[slot].busy) return;
    Ray ray;
    ray.busy = true;
    ray.segment = hard_segment(random_, case_);
    ray.state = setup(grid_, ray.segment.p0, ray.segment.p1);
    const int a = ray.state.axis;
    if (random_.chance(0.3)) {
      ray.limit = random_.between(0, std::abs(ray.segment.p1[a] - ray.segment.p0[a]));
    }
    rays_[slot] = ray;
    next_ = slot;
    limit_told_ = ray.limit == kNoLimit;
    rtl_->alloc_i = static_cast<std::uint8_t>(64 + kUnits * slot);
    --left;
  } else if (next_ && !limit_told_) {
    rtl_->interrupt_i = static_cast<std::uint32_t>((1U << 24U) + ((kUnits * *next_) << 18U)) +
                        static_cast<std::uint32_t>(rays_[*next_].limit);
    limit_told_ = true;
  } else if (next_ && random_.between(0, 99) < offer) {
    rtl_->start_valid_i = 1;
    rtl_->start_slot_i = static_cast<std::uint8_t>(kUnits * *next_);
    put_state(rtl_->start_i, rays_[*next_].state);
  }
}

void Traverse::check_step() {
  if (!rtl_->tap_valid_o) {
    ASSERT_EQ(rtl_->inc_valid_o, 0);
    ASSERT_EQ(rtl_->done_valid_o, 0);
    return;
  }
  ASSERT_EQ(rtl_->tap_slot_o % kUnits, 0);
  const auto slot = static_cast<std::size_t>(rtl_->tap_slot_o / kUnits);
  Ray& ray = rays_[slot];
  ASSERT_TRUE(ray.busy);
  const Step step = march::step(grid_, ray.state, ray.limit, [&](int address) {
    return blocks_.at(static_cast<std::size_t>(address));
  });
  ++steps_;
  longest_jump_ = std::max(longest_jump_, step.jump);
  ASSERT_EQ(rtl_->tap_block_o, step.block);
  ASSERT_EQ(rtl_->tap_cand_o, step.cand);
  ASSERT_EQ(rtl_->tap_jump_o, step.jump);
  ASSERT_EQ(rtl_->done_valid_o != 0, step.done);
  ASSERT_EQ(rtl_->inc_valid_o != 0, step.cand != 0);
  if (step.cand != 0) {
    ASSERT_EQ(rtl_->inc_count_o, std::popcount(step.cand));
    sent_.emplace_back(slot, step);
  }
  if (step.done) {
    ASSERT_EQ(rtl_->done_slot_o, kUnits * slot);
    ray.busy = false;
  }
}

void Traverse::check_bundle() {
  if (!rtl_->bundle_valid_o || !rtl_->bundle_ready_i) return;
  ASSERT_FALSE(sent_.empty());
  const auto& [slot, step] = sent_.front();
  const Bundle got = get_bundle(rtl_->bundle_o);
  ASSERT_EQ(got.slot, kUnits * slot);
  ASSERT_EQ(got.base, step.base);
  ASSERT_EQ(got.occ, step.occ);
  ASSERT_EQ(got.cand, step.cand);
  ASSERT_EQ(got.front & step.met, step.front);
  ASSERT_EQ(got.near_enter, step.near_enter);
  if ((step.cand & ~step.front) != 0) {
    ASSERT_EQ(got.far_enter, step.far_enter);
  }
  for (unsigned voxel = 0; voxel < 8; ++voxel) {
    ASSERT_EQ(cells_of(got, voxel), step.cells[voxel]) << "voxel " << voxel;
  }
  sent_.pop_front();
}

void Traverse::run(int rays, int offer, int take) {
  std::array<std::uint32_t, 3> reads{};  // records on their way: two clocks
  int left = rays;
  const long end = rtl_.clocks() + 1'000'000;
  const auto busy = [&] {
    bool any = left > 0 || !sent_.empty();
    for (const Ray& ray : rays_) any = any || ray.busy;
    return any;
  };
  while (busy()) {
    ASSERT_LT(rtl_.clocks(), end);
    begin_rays(left, offer);
    rtl_->few_i = static_cast<std::uint16_t>(random_.below(65536) | random_.below(65536));
    rtl_->idle_i = static_cast<std::uint16_t>(random_.below(65536));
    rtl_->bundle_ready_i = random_.between(0, 99) < take;
    rtl_->block_data_i = reads[1];
    rtl_.settle();
    check_step();
    check_bundle();
    if (HasFatalFailure()) return;
    reads[1] = reads[0];
    if (rtl_->block_enable_o) {
      const std::size_t address = rtl_->block_address_o;
      ASSERT_LT(address, blocks_.size());
      reads[0] = blocks_[address].bits();
    }
    if (rtl_->start_valid_i && rtl_->start_ready_o) next_.reset();
    rtl_.tick();
  }
}

TEST_F(Traverse, EqualsTheModel) {
  const std::array<double, 3> densities{0.01, 0.2, 0.9};
  std::size_t i = 0;
  for (const Case& c : hard_grids(17)) {
    start(c, densities[i % 3]);
    run(150, 90, (i % 4 == 0) ? 30 : 90);
    ASSERT_FALSE(HasFatalFailure()) << "grid " << i;
    ++i;
  }
  EXPECT_GT(steps(), 50'000);
  EXPECT_EQ(longest_jump(), 7);  // the farthest that a record can name
}

}  // namespace
}  // namespace gridrt::march
