// A loop over a range, shared out over threads; what it computes never depends on their number.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <system_error>
#include <thread>
#include <vector>

namespace gridrt {

/// Threads to use for a wish of `threads` (0: one a core), at least 1.
inline int resolve_threads(int threads) {
  if (threads > 0) return threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

inline constexpr std::size_t kPiece = 1024;  ///< of a range, that a thread takes at a time

/// Calls body(first, last) once for every piece of [0, count), in any order, from up to `threads`
/// threads; `first` is a multiple of kPiece. The body must not throw and must write only what
/// belongs to its own piece.
template <class Body>
void parallel_pieces(int threads, std::size_t count, const Body& body) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (;;) {
      const std::size_t first = next.fetch_add(kPiece, std::memory_order_relaxed);
      if (first >= count) return;
      body(first, std::min(count, first + kPiece));
    }
  };
  const std::size_t useful = (count + kPiece - 1) / kPiece;
  const std::size_t helpers =
      std::min(useful, static_cast<std::size_t>(resolve_threads(threads))) - (useful > 0 ? 1 : 0);
  std::vector<std::jthread> pool;
  pool.reserve(helpers);
  for (std::size_t i = 0; i < helpers; ++i) {
    try {
      pool.emplace_back(work);
    } catch (const std::system_error&) {
      break;  // no more threads to be had: the others do the work
    }
  }
  work();
}

/// Calls body(i) once for every i in [0, count), in any order, likewise.
template <class Body>
void parallel_for(int threads, std::size_t count, const Body& body) {
  parallel_pieces(threads, count, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) body(i);
  });
}

}  // namespace gridrt
