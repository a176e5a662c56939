// A JSON value together with its place, read strictly: whatever has the wrong type is refused by
// name, never replaced by a default.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace gridrt::scene_detail {

/// A value within a JSON document, with its path. All functions throw a Refusal (kInput) that names
/// file and path where the value is not as the function asks. The document and the file's name
/// outlive the node.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string path, const std::string& file)
      : value_(&value), path_(std::move(path)), file_(&file) {}

  /// A member of this object, if it has it.
  std::optional<JsonNode> find(const char* key) const;
  /// A member that this object must have.
  JsonNode at(const char* key) const;
  /// A member by a chain of keys, if all of them exist.
  std::optional<JsonNode> find(const char* key, const char* inner) const;

  /// Number of elements of this array, and one of them.
  std::size_t size() const;
  JsonNode operator[](std::size_t index) const;

  double number() const;
  bool boolean() const;
  std::string text() const;
  /// A whole number in [0, limit).
  std::uint64_t whole(std::uint64_t limit = std::uint64_t{1} << 53U) const;
  /// A whole number that counts elements of `what`, of which there are `count`.
  std::size_t index(std::size_t count, const char* what) const;
  /// An array of exactly N numbers.
  template <std::size_t N>
  std::array<double, N> numbers() const {
    std::array<double, N> values{};
    if (size() != N) {
      refuse_value("is not an array of " + std::to_string(N) + " numbers");
    }
    for (std::size_t i = 0; i < N; ++i) {
      values[i] = (*this)[i].number();
    }
    return values;
  }

  const std::string& path() const { return path_; }

  /// Refuses this value: "FILE: PATH what".
  [[noreturn]] void refuse_value(const std::string& what) const;

 private:
  const nlohmann::json* value_;
  std::string path_;
  const std::string* file_;
};

}  // namespace gridrt::scene_detail
