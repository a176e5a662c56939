#include "host/scene/gltf_accessor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

namespace gridrt::scene_detail {
namespace {

enum Component : std::uint32_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

std::size_t bytes_of(std::uint64_t component) {
  switch (component) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

GltfAccessor::GltfAccessor(GltfDocument& document, const JsonNode& reference, const char* type)
    : node_(document.element("accessors", reference)) {
  if (node_.find("sparse")) {
    node_.refuse_value("is sparse, which is not read");
  }
  const std::string found = node_.at("type").text();
  if (found != type) {
    node_.refuse_value(fmt::format("has another type than {}", type));
  }
  const std::uint64_t component = node_.at("componentType").whole();
  component_size_ = bytes_of(component);
  if (component_size_ == 0) {
    node_.at("componentType").refuse_value("is not one of glTF 2.0");
  }
  component_type_ = static_cast<std::uint32_t>(component);
  const auto normalized = node_.find("normalized");
  normalized_ = normalized && normalized->boolean();
  const auto view_reference = node_.find("bufferView");
  if (!view_reference) {
    node_.refuse_value("has no bufferView");
  }
  const JsonNode view = document.element("bufferViews", *view_reference);
  bytes_ = document.view(view);
  const auto offset_node = node_.find("byteOffset");
  const std::uint64_t offset = offset_node ? offset_node->whole() : 0;
  const std::size_t element = component_size_ * (found == "VEC3" ? 3 : 1);
  constexpr std::uint64_t kMaxStride = 65536;
  const auto stride = view.find("byteStride");
  stride_ = stride ? stride->whole(kMaxStride) : element;
  count_ = node_.at("count").whole();
  // No overflow: count is at most the number of bytes, the stride below 2^16.
  const std::uint64_t available = bytes_.size() - std::min<std::uint64_t>(offset, bytes_.size());
  if (stride_ < element || count_ > bytes_.size() ||
      (count_ > 0 && (count_ - 1) * stride_ + element > available)) {
    node_.refuse_value(
        fmt::format("of {} elements of {} bytes, {} apart from byte {}, does not fit "
                    "into its buffer view of {} bytes",
                    count_, element, stride_, offset, bytes_.size()));
  }
  bytes_.remove_prefix(std::min<std::size_t>(offset, bytes_.size()));
}

bool GltfAccessor::is_index_type() const {
  return !normalized_ && (component_type_ == kUnsignedByte || component_type_ == kUnsignedShort ||
                          component_type_ == kUnsignedInt);
}

double GltfAccessor::component(std::size_t offset) const {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < component_size_; ++i) {
    bits |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes_[offset + i])) << (8 * i);
  }
  const auto scaled = [&](double value, double largest) {
    return normalized_ ? std::max(value / largest, -1.0) : value;
  };
  switch (component_type_) {
    case kByte:
      return scaled(static_cast<std::int8_t>(bits), 127.0);
    case kUnsignedByte:
      return scaled(bits, 255.0);
    case kShort:
      return scaled(static_cast<std::int16_t>(bits), 32767.0);
    case kUnsignedShort:
      return scaled(bits, 65535.0);
    case kFloat:
      return static_cast<double>(std::bit_cast<float>(bits));
    default:
      return bits;
  }
}

std::uint32_t GltfAccessor::index(std::size_t i) const {
  return static_cast<std::uint32_t>(component(i * stride_));
}

glm::dvec3 GltfAccessor::vector(std::size_t i) const {
  glm::dvec3 value(0.0);
  for (int k = 0; k < 3; ++k) {
    value[k] = component(i * stride_ + static_cast<std::size_t>(k) * component_size_);
    if (!std::isfinite(value[k])) {
      node_.refuse_value(fmt::format("element {} is not finite", i));
    }
  }
  return value;
}

}  // namespace gridrt::scene_detail
