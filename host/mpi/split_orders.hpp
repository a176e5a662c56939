// Orders of which each group of ranks has a part: what is still open, and answers put together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "host/pe/crew.hpp"

namespace gridrt {

/// Neighbouring rays of an order, a batch for one group.
struct OrderPart {
  int group = 0;
  std::size_t first = 0;  ///< ray of the order
  std::size_t count = 0;
};

/// Rays in `groups` parts of like size, none of them empty; the first is group 0's. Without rays,
/// no parts.
std::vector<OrderPart> split_order(std::size_t rays, int groups);

class SplitOrders {
 public:
  /// Begins an order, whose parts follow one by one.
  void begin(const TraceOrder& order, std::size_t parts, std::size_t hit_bytes);

  /// A part of the order that was begun last. No other part has had its number.
  void add(std::uint32_t batch, const OrderPart& part);

  /// What a group answers: hit records in the order of its rays. False if they are too few or too
  /// many. Of a part that is not open, nothing happens.
  [[nodiscard]] bool answer(std::uint32_t batch, std::span<const std::byte> hits);

  /// A part that cannot be answered; a ray's place in it becomes the place in the order.
  void refuse(std::uint32_t batch, Refusal refusal);

  /// The next order of which no part is open. Refused parts refuse it, the first of them.
  std::optional<TraceAnswer> take();

  /// True if there is no order.
  [[nodiscard]] bool empty() const { return orders_.empty(); }
  [[nodiscard]] std::size_t size() const { return orders_.size(); }

  /// True while a part of this group is open.
  [[nodiscard]] bool expects(int group) const;

  void clear();

 private:
  struct Order {
    TraceAnswer answer;
    std::size_t hit_bytes = 0;
    std::size_t open = 0;           ///< parts
    std::size_t refused_first = 0;  ///< of the part that the refusal is about
  };
  struct Open {
    std::uint32_t order = 0;
    OrderPart part;
  };
  void close(std::map<std::uint32_t, Open>::iterator part);

  std::uint32_t next_order_ = 0;
  std::map<std::uint32_t, Order> orders_;
  std::map<std::uint32_t, Open> parts_;  ///< by number of the batch
  std::deque<std::uint32_t> done_;
};

}  // namespace gridrt
