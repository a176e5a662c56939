// Little-endian values in a row: what the Scene section is written with and read from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gridrt {

/// Appends values to a byte vector.
class ByteWriter {
 public:
  void u8(std::uint8_t value) { bytes_.push_back(static_cast<std::byte>(value)); }
  void u32(std::uint32_t value);
  void f32(float value);
  void f64(double value);
  /// Length, then the bytes.
  void text(std::string_view value);

  std::vector<std::byte> take() { return std::move(bytes_); }

 private:
  std::vector<std::byte> bytes_;
};

/// Takes values off the front. A read past the end gives zeros and is remembered: ask good() before
/// trusting what was read.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::uint8_t u8();
  std::uint32_t u32();
  float f32();
  double f64();
  std::string text();

  /// True if `count` items of `size` bytes each are still there; else the reader turns bad.
  bool has(std::uint64_t count, std::uint64_t size);

  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[nodiscard]] std::size_t offset() const { return at_; }

 private:
  std::span<const std::byte> take(std::size_t count);

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

}  // namespace gridrt
