#include "host/mpi/split_orders.hpp"

#include <algorithm>
#include <utility>

namespace gridrt {

std::vector<OrderPart> split_order(std::size_t rays, int groups) {
  const auto count = std::min(static_cast<std::size_t>(groups), rays);
  std::vector<OrderPart> parts;
  for (std::size_t g = 0; g < count; ++g) {
    const std::size_t first = rays * g / count;
    parts.push_back({static_cast<int>(g), first, rays * (g + 1) / count - first});
  }
  return parts;
}

void SplitOrders::begin(const TraceOrder& order, std::size_t parts, std::size_t hit_bytes) {
  Order& begun = orders_[++next_order_];
  begun.answer = {order.sequence, order.head, {}, {}};
  begun.answer.hits.resize(order.head.count * hit_bytes);
  begun.hit_bytes = hit_bytes;
  begun.open = parts;
}

void SplitOrders::add(std::uint32_t batch, const OrderPart& part) {
  parts_[batch] = {next_order_, part};
}

bool SplitOrders::answer(std::uint32_t batch, std::span<const std::byte> hits) {
  const auto part = parts_.find(batch);
  if (part == parts_.end()) return true;
  Order& order = orders_.at(part->second.order);
  const auto& [group, first, count] = part->second.part;
  if (hits.size() != count * order.hit_bytes) return false;
  std::ranges::copy(hits, std::span(order.answer.hits).subspan(first * order.hit_bytes).begin());
  close(part);
  return true;
}

void SplitOrders::refuse(std::uint32_t batch, Refusal refusal) {
  const auto part = parts_.find(batch);
  if (part == parts_.end()) return;
  Order& order = orders_.at(part->second.order);
  const std::size_t first = part->second.part.first;
  if (refusal.code == protocol::ErrorCode::kBadRay) {
    refusal.detail += static_cast<std::uint32_t>(first);
  }
  if (!order.answer.refusal || first < order.refused_first) {
    order.answer.refusal = refusal;
    order.refused_first = first;
  }
  close(part);
}

void SplitOrders::close(std::map<std::uint32_t, Open>::iterator part) {
  const std::uint32_t id = part->second.order;
  parts_.erase(part);
  if (--orders_.at(id).open == 0) done_.push_back(id);
}

std::optional<TraceAnswer> SplitOrders::take() {
  if (done_.empty()) return std::nullopt;
  const auto order = orders_.find(done_.front());
  done_.pop_front();
  TraceAnswer answer = std::move(order->second.answer);
  orders_.erase(order);
  return answer;
}

bool SplitOrders::expects(int group) const {
  return std::ranges::any_of(parts_,
                             [&](const auto& entry) { return entry.second.part.group == group; });
}

void SplitOrders::clear() {
  orders_.clear();
  parts_.clear();
  done_.clear();
}

}  // namespace gridrt
