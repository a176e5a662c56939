// The typed arrays of glTF, with every bound checked before the first read.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <glm/vec3.hpp>

#include "host/scene/gltf_document.hpp"

namespace gridrt::scene_detail {

/// An array of scalars or vectors in a buffer.
class GltfAccessor {
 public:
  /// Opens the accessor that `reference` names; it must be of `type` ("SCALAR" or "VEC3"). Refused:
  /// sparse accessors, none of a buffer view, any byte outside of it.
  GltfAccessor(GltfDocument& document, const JsonNode& reference, const char* type);

  std::size_t count() const { return count_; }
  /// Element i of an index accessor, which has an unsigned integer type.
  std::uint32_t index(std::size_t i) const;
  /// Element i of a VEC3 accessor; normalised integers become fractions. Refuses NaN and infinity.
  glm::dvec3 vector(std::size_t i) const;
  /// True if elements are unsigned integers that are not normalised.
  bool is_index_type() const;

  [[noreturn]] void refuse_value(const std::string& what) const { node_.refuse_value(what); }

 private:
  double component(std::size_t offset) const;

  JsonNode node_;
  std::string_view bytes_;
  std::uint32_t component_type_ = 0;
  std::size_t component_size_ = 0;
  std::size_t stride_ = 0;
  std::size_t count_ = 0;
  bool normalized_ = false;
};

}  // namespace gridrt::scene_detail
