#include "host/scene/toml_value.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/scene/refuse.hpp"
#include "host/scene/text.hpp"
#include "host/scene/toml_library.hpp"

namespace gridrt::scene_detail {

std::string TomlValue::place() const {
  return fmt::format("{}:{}", *file_, node_->source().begin.line);
}

void TomlValue::refuse_value(const std::string& what, std::string advice) const {
  refuse(ErrorKind::kInput, fmt::format("{}: {} {}", place(), key_, what), std::move(advice));
}

const toml::table& TomlValue::as_table() const {
  if (const toml::table* table = node_->as_table()) {
    return *table;
  }
  refuse_value("is not a table");
}

void TomlValue::allow_keys(std::initializer_list<std::string_view> keys) const {
  for (const auto& [key, value] : as_table()) {
    if (std::find(keys.begin(), keys.end(), key.str()) == keys.end()) {
      refuse(ErrorKind::kInput,
             fmt::format("{}:{}: unknown key '{}' in {}", *file_, key.source().begin.line,
                         shorten(key.str()), key_),
             fmt::format("keys are {}", fmt::join(keys, ", ")));
    }
  }
}

std::optional<TomlValue> TomlValue::find(std::string_view key) const {
  const toml::node* node = as_table().get(key);
  if (node == nullptr) {
    return std::nullopt;
  }
  return TomlValue(*node, std::string(key), *file_);
}

TomlValue TomlValue::at(std::string_view key) const {
  auto value = find(key);
  if (!value) {
    refuse_value(fmt::format("has no '{}'", key));
  }
  return std::move(*value);
}

bool TomlValue::is_array() const { return node_->is_array(); }

std::vector<TomlValue> TomlValue::elements() const {
  const toml::array* array = node_->as_array();
  if (array == nullptr) {
    refuse_value("is not an array");
  }
  std::vector<TomlValue> values;
  for (const toml::node& element : *array) {
    values.emplace_back(element, key_, *file_);
  }
  return values;
}

double TomlValue::number() const {
  if (!node_->is_number()) {
    refuse_value("is not a number");
  }
  const double value = node_->value<double>().value_or(std::nan(""));
  if (!std::isfinite(value)) {
    refuse_value("is not finite");
  }
  return value;
}

double TomlValue::number_in(double lowest, double highest) const {
  const double value = number();
  if (value < lowest || value > highest) {
    refuse_value(fmt::format("is {}, but must be from {} to {}", value, lowest, highest));
  }
  return value;
}

bool TomlValue::boolean() const {
  if (!node_->is_boolean()) {
    refuse_value("is neither true nor false");
  }
  return node_->value_or(false);
}

std::string TomlValue::text() const {
  if (!node_->is_string()) {
    refuse_value("is not a string");
  }
  return node_->value_or(std::string{});
}

glm::dvec3 TomlValue::vector() const {
  const std::vector<TomlValue> parts = elements();
  if (parts.size() != 3) {
    refuse_value("is not an array of three numbers");
  }
  return {parts[0].number(), parts[1].number(), parts[2].number()};
}

glm::vec3 TomlValue::colour(double highest) const {
  if (!is_array()) {
    return glm::vec3(static_cast<float>(number_in(0.0, highest)));
  }
  const glm::dvec3 value = vector();
  for (int i = 0; i < 3; ++i) {
    if (value[i] < 0.0 || value[i] > highest) {
      refuse_value(fmt::format("has a part of {}, but must be from 0 to {}", value[i], highest));
    }
  }
  return glm::vec3(value);
}

glm::dmat4 TomlValue::matrix() const {
  const std::vector<TomlValue> rows = elements();
  if (rows.size() != 3 && rows.size() != 4) {
    refuse_value("is not an array of 3 or 4 rows");
  }
  glm::dmat4 matrix(1.0);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::vector<TomlValue> parts = rows[row].elements();
    if (parts.size() != 4) {
      rows[row].refuse_value("has a row that is not of four numbers");
    }
    for (std::size_t column = 0; column < 4; ++column) {
      matrix[static_cast<int>(column)][static_cast<int>(row)] = parts[column].number();
    }
  }
  if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0) {
    refuse_value("is not affine", "its last row is [0, 0, 0, 1]");
  }
  return matrix;
}

}  // namespace gridrt::scene_detail
