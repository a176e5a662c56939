// A TOML value with its place, read strictly: unknown keys and wrong types are refused by line.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace toml {
inline namespace v3 {
class node;   // NOLINT(readability-identifier-naming): the library's own names
class table;  // NOLINT(readability-identifier-naming)
}  // namespace v3
}  // namespace toml

namespace gridrt::scene_detail {

/// A value within a TOML document. All functions throw a Refusal (kInput) that names file, line and
/// key where the value is not as the function asks. The document and the file's name outlive it.
class TomlValue {
 public:
  TomlValue(const toml::node& node, std::string key, const std::string& file)
      : node_(&node), key_(std::move(key)), file_(&file) {}

  /// Refuses keys of this table that are not among `keys`.
  void allow_keys(std::initializer_list<std::string_view> keys) const;
  /// A value of this table, if it has it.
  std::optional<TomlValue> find(std::string_view key) const;
  /// A value that this table must have.
  TomlValue at(std::string_view key) const;
  /// The elements of this array.
  std::vector<TomlValue> elements() const;

  bool is_array() const;
  double number() const;
  bool boolean() const;
  std::string text() const;
  /// An array of three numbers.
  glm::dvec3 vector() const;
  /// A colour: three numbers, or one for all; each from 0 to `highest`.
  glm::vec3 colour(double highest) const;
  /// A number from `lowest` to `highest`.
  double number_in(double lowest, double highest) const;
  /// 3 or 4 rows of 4 numbers; the last of 4 is 0 0 0 1.
  glm::dmat4 matrix() const;

  /// "FILE:LINE" of this value.
  std::string place() const;
  /// Refuses this value: "FILE:LINE: KEY what".
  [[noreturn]] void refuse_value(const std::string& what, std::string advice = {}) const;

 private:
  const toml::table& as_table() const;

  const toml::node* node_;
  std::string key_;
  const std::string* file_;
};

}  // namespace gridrt::scene_detail
