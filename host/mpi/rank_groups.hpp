// Ranks in groups of one size, each of neighbours and with a whole set of PEs.
#pragma once

#include <cstdint>

namespace gridrt {

struct RankGroups {
  int ranks = 1;
  int groups = 1;  ///< divides `ranks`

  [[nodiscard]] int size() const { return ranks / groups; }
  [[nodiscard]] int group_of(int rank) const { return rank / size(); }
  /// The group's rank 0, which collects its answers.
  [[nodiscard]] int first(int group) const { return group * size(); }
  /// A rank's number in its group.
  [[nodiscard]] int member(int rank) const { return rank % size(); }
  /// Who of the group owns PE `pe`.
  [[nodiscard]] int owner(int group, std::uint32_t pe) const {
    return first(group) + static_cast<int>(pe % static_cast<std::uint32_t>(size()));
  }
};

}  // namespace gridrt
