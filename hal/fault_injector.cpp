#include "hal/fault_injector.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kMostGarbage = 64;

void append(std::vector<std::byte>& out, std::span<const std::byte> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

FaultInjector::FaultInjector(const FaultRates& rates, std::uint64_t seed)
    : rates_(rates), random_(seed) {}

// Not a distribution of the standard library: those differ between libraries, a schedule must not.
std::size_t FaultInjector::below(std::size_t bound) { return random_() % bound; }

void FaultInjector::apply(std::span<const std::byte> in, std::vector<std::byte>& out) {
  reader_.push(in);
  while (const auto event = reader_.next()) {
    if (const auto* frame = std::get_if<Frame>(&*event)) {
      pass(frame->bytes, out);
    }
  }
}

void FaultInjector::pass(std::span<const std::byte> frame, std::vector<std::byte>& out) {
  double dice = static_cast<double>(random_() >> 11U) * 0x1p-53;
  const auto happens = [&](double rate) {
    if (faults_ >= rates_.limit || dice >= rate) {
      dice -= rate;
      return false;
    }
    ++faults_;
    return true;
  };
  if (happens(rates_.drop)) {
    return;
  }
  if (happens(rates_.reorder)) {
    append(out, held_);
    held_.assign(frame.begin(), frame.end());
    return;
  }
  if (happens(rates_.flip)) {
    append(out, frame);
    const std::size_t bit = below(8 * frame.size());
    out[out.size() - frame.size() + bit / 8] ^= static_cast<std::byte>(1U << (bit % 8));
  } else if (happens(rates_.truncate)) {
    append(out, frame.first(below(frame.size())));
  } else if (happens(rates_.duplicate)) {
    append(out, frame);
    append(out, frame);
  } else {
    if (happens(rates_.garbage)) {
      for (std::size_t i = 0, count = 1 + below(kMostGarbage); i < count; ++i) {
        out.push_back(static_cast<std::byte>(random_() & 0xFFU));
      }
    }
    append(out, frame);
  }
  append(out, held_);
  held_.clear();
}

}  // namespace gridrt
