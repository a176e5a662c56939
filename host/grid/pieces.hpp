// A loop over a range, shared out over the threads of OpenMP; what it computes never depends on
// their number. For code that is compiled with OpenMP.
#pragma once

#include <algorithm>
#include <cstddef>

namespace gridrt {

inline constexpr std::size_t kPiece = 1024;  ///< of a range, that a thread takes at a time

/// Number of pieces of [0, count).
constexpr std::size_t pieces_of(std::size_t count) { return (count + kPiece - 1) / kPiece; }

/// Calls body(piece, first, last) once for each piece of [0, count), in any order, from `threads`
/// (>= 1) threads. The body must not throw and must write only what belongs to its own piece.
template <class Body>
void for_pieces(std::size_t count, int threads, const Body& body) {
  const auto pieces = static_cast<std::ptrdiff_t>(pieces_of(count));
#pragma omp parallel for num_threads(threads) if (threads > 1 && pieces > 1) schedule(dynamic)
  for (std::ptrdiff_t i = 0; i < pieces; ++i) {
    const auto piece = static_cast<std::size_t>(i);
    body(piece, piece * kPiece, std::min(count, (piece + 1) * kPiece));
  }
}

}  // namespace gridrt
