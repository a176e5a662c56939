#include "host/scene/ply_body.hpp"

#include <array>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "host/scene/number.hpp"

namespace gridrt::scene_detail {

PlyBody::PlyBody(std::string_view bytes, const PlyHeader& header, const std::string& name)
    : bytes_(bytes.substr(header.body_from)),
      lines_(bytes_),
      encoding_(header.encoding),
      first_line_(header.lines),
      name_(name) {}

Result<void> PlyBody::begin(const PlyElement& element, std::uint64_t number) {
  if (number == 0) {
    element_ = shorten(element.name);
  }
  number_ = number;
  if (encoding_ != PlyEncoding::kAscii || element.properties.empty()) {
    return {};
  }
  for (auto line = lines_.next(); line; line = lines_.next()) {
    line_ = trim(*line);
    if (!line_.empty()) {
      return {};
    }
  }
  return bad("the file ends before it");
}

Result<void> PlyBody::end() const {
  if (encoding_ == PlyEncoding::kAscii && !trim(line_).empty()) {
    return bad("more values than the element has properties");
  }
  return {};
}

Result<PlyValue> PlyBody::next(PlyType type) {
  if (encoding_ == PlyEncoding::kAscii) {
    const std::string_view token = next_token(line_);
    if (token.empty()) {
      return bad("fewer values than the element has properties");
    }
    return PlyValue{0.0, token};
  }
  if (size_of(type) > bytes_.size() - offset_) {
    return bad("the file ends within it");
  }
  const double number = binary(type);
  offset_ += size_of(type);
  return PlyValue{number, {}};
}

Result<float> PlyBody::real(const PlyValue& value) const {
  if (!value.text.empty()) {
    const auto parsed = parse_float(value.text);
    if (!parsed) {
      return bad(parsed.error().message);
    }
    return *parsed;
  }
  const auto rounded = static_cast<float>(value.number);
  if (!std::isfinite(rounded)) {
    return bad(std::isfinite(value.number) ? "a value is beyond the range of float32"
                                           : "a value is not finite");
  }
  return rounded;
}

Result<std::int64_t> PlyBody::integer(const PlyValue& value) const {
  if (value.text.empty()) {
    return static_cast<std::int64_t>(value.number);
  }
  const auto parsed = parse_integer(value.text);
  if (!parsed) {
    return bad(fmt::format("'{}' is not a whole number", shorten(value.text)));
  }
  return *parsed;
}

Result<std::uint64_t> PlyBody::list_length(const PlyProperty& property) {
  const auto value = next(property.count_type.value_or(property.type));
  if (!value) {
    return std::unexpected(value.error());
  }
  const auto length = integer(*value);
  if (!length) {
    return std::unexpected(length.error());
  }
  const bool text = encoding_ == PlyEncoding::kAscii;
  const std::uint64_t left =
      text ? (line_.size() + 1) / 2 : (bytes_.size() - offset_) / size_of(property.type);
  if (*length < 0 || static_cast<std::uint64_t>(*length) > left) {
    return bad(fmt::format("a list of {} values, but at most {} follow", *length, left));
  }
  return static_cast<std::uint64_t>(*length);
}

Result<void> PlyBody::skip(const PlyProperty& property) {
  std::uint64_t count = 1;
  if (property.count_type) {
    const auto length = list_length(property);
    if (!length) {
      return std::unexpected(length.error());
    }
    count = *length;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    if (const auto value = next(property.type); !value) {
      return std::unexpected(value.error());
    }
  }
  return {};
}

bool PlyBody::has_more() {
  if (encoding_ != PlyEncoding::kAscii) {
    return offset_ < bytes_.size();
  }
  for (auto line = lines_.next(); line; line = lines_.next()) {
    if (!trim(*line).empty()) {
      return true;
    }
  }
  return false;
}

std::unexpected<Error> PlyBody::bad(const std::string& what) const {
  const std::string place =
      encoding_ == PlyEncoding::kAscii
          ? fmt::format("{}:{}: {} {}", name_, first_line_ + lines_.number(), element_, number_)
          : fmt::format("{}: {} {} (byte {} of the data)", name_, element_, number_, offset_);
  return fail(ErrorKind::kInput, fmt::format("{}: {}", place, what));
}

// The value at the offset as a double, which holds all eight types exactly.
double PlyBody::binary(PlyType type) const {
  std::array<unsigned char, 8> raw{};
  const std::size_t size = size_of(type);
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t from = encoding_ == PlyEncoding::kLittleEndian ? i : size - 1 - i;
    raw[i] = static_cast<unsigned char>(bytes_[offset_ + from]);
  }
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i) {
    bits |= static_cast<std::uint64_t>(raw[i]) << (8 * i);
  }
  switch (type) {
    case PlyType::kInt8:
      return static_cast<std::int8_t>(bits);
    case PlyType::kInt16:
      return static_cast<std::int16_t>(bits);
    case PlyType::kInt32:
      return static_cast<std::int32_t>(bits);
    case PlyType::kFloat32:
      return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    case PlyType::kFloat64:
      return std::bit_cast<double>(bits);
    case PlyType::kUint8:
    case PlyType::kUint16:
    case PlyType::kUint32:
      break;
  }
  return static_cast<double>(bits);
}

}  // namespace gridrt::scene_detail
