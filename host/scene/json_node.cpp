#include "host/scene/json_node.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/scene/refuse.hpp"

namespace gridrt::scene_detail {

void JsonNode::refuse_value(const std::string& what) const {
  refuse(ErrorKind::kInput,
         fmt::format("{}: {} {}", *file_, path_.empty() ? "the document" : path_, what));
}

std::optional<JsonNode> JsonNode::find(const char* key) const {
  if (!value_->is_object()) {
    refuse_value("is not an object");
  }
  const auto member = value_->find(key);
  if (member == value_->end()) {
    return std::nullopt;
  }
  return JsonNode(*member, path_.empty() ? key : path_ + "." + key, *file_);
}

JsonNode JsonNode::at(const char* key) const {
  auto member = find(key);
  if (!member) {
    refuse_value(fmt::format("has no '{}'", key));
  }
  return std::move(*member);
}

std::optional<JsonNode> JsonNode::find(const char* key, const char* inner) const {
  const auto member = find(key);
  return member ? member->find(inner) : std::nullopt;
}

std::size_t JsonNode::size() const {
  if (!value_->is_array()) {
    refuse_value("is not an array");
  }
  return value_->size();
}

JsonNode JsonNode::operator[](std::size_t index) const {
  return {(*value_)[index], fmt::format("{}[{}]", path_, index), *file_};
}

double JsonNode::number() const {
  if (!value_->is_number()) {
    refuse_value("is not a number");
  }
  const auto number = value_->get<double>();
  if (!std::isfinite(number)) {
    refuse_value("is not finite");
  }
  return number;
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) {
    refuse_value("is neither true nor false");
  }
  return value_->get<bool>();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) {
    refuse_value("is not a string");
  }
  return value_->get<std::string>();
}

std::uint64_t JsonNode::whole(std::uint64_t limit) const {
  if (!value_->is_number_unsigned()) {
    refuse_value("is not a whole number >= 0");
  }
  const auto number = value_->get<std::uint64_t>();
  if (number >= limit) {
    refuse_value(fmt::format("is {}, but must be below {}", number, limit));
  }
  return number;
}

std::size_t JsonNode::index(std::size_t count, const char* what) const {
  if (!value_->is_number_unsigned() || value_->get<std::uint64_t>() >= count) {
    refuse_value(fmt::format("is not the index of one of {} {}", count, what));
  }
  return value_->get<std::size_t>();
}

}  // namespace gridrt::scene_detail
