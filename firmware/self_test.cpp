// The self-test: a small image and rays go the way of every image and ray, and every byte of the
// answers is compared.
#include "firmware/feed.hpp"
#include "firmware/firmware.hpp"

namespace gridrt::firmware {

using wire::SelfTestState;

namespace {

/// Compares answers with what they should be.
class Comparison {
 public:
  Comparison(Feed& feed, const SelfTestVectors& vectors) : feed_(feed), vectors_(vectors) {}

  /// Takes what has come; false once a byte was wrong or too many.
  bool listen() {
    for (int byte = feed_.byte(); byte >= 0; byte = feed_.byte()) {
      if (right_ == vectors_.answer_bytes || vectors_.answers[right_] != byte) wrong_ = true;
      if (wrong_) return false;
      ++right_;
    }
    return true;
  }

  [[nodiscard]] bool complete() const { return right_ == vectors_.answer_bytes; }
  [[nodiscard]] bool wrong() const { return wrong_; }
  [[nodiscard]] uint32_t right() const { return right_; }

 private:
  Feed& feed_;
  const SelfTestVectors& vectors_;
  uint32_t right_ = 0;
  bool wrong_ = false;
};

/// True if every answer was right and nothing else came.
bool run(Feed& feed, const SelfTestVectors& vectors, Comparison& comparison) {
  for (uint32_t w = 0; w < vectors.frame_words; ++w) {
    uint32_t polls = 0;
    while (!feed.has_room()) {
      if (!comparison.listen() || ++polls > kRoomPolls) return false;
    }
    feed.put(vectors.frames[w]);
  }
  for (uint32_t polls = 0; polls < kAnswerPolls && !comparison.complete(); ++polls) {
    if (!comparison.listen()) return false;
  }
  return comparison.complete() && comparison.listen();
}

}  // namespace

void Firmware::run_self_test() {
  const bool was_booted = boot_.state == wire::BootState::kBooted;
  Feed feed(registers_);
  if (!feed.take()) {
    self_test_.state = SelfTestState::kBusy;
    return;
  }
  Comparison comparison(feed, vectors_);
  const bool passed = run(feed, vectors_, comparison);
  self_test_.state = passed ? SelfTestState::kPassed : SelfTestState::kFailed;
  self_test_.bytes = comparison.right();
  ++self_test_.runs;
  reset_core();  // the host shall not meet the test's image
  feed.give_back();
  note(passed ? wire::JournalCode::kSelfTestPassed : wire::JournalCode::kSelfTestFailed,
       passed ? vectors_.rays : self_test_.bytes);
  if (was_booted) boot();
}

}  // namespace gridrt::firmware
