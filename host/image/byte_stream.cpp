#include "host/image/byte_stream.hpp"

#include <array>
#include <bit>

#include "gridrt_protocol.hpp"

namespace gridrt {

void ByteWriter::u32(std::uint32_t value) {
  std::array<std::byte, 4> raw{};
  protocol::detail::put32(raw.data(), value);
  bytes_.insert(bytes_.end(), raw.begin(), raw.end());
}

void ByteWriter::f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }

void ByteWriter::f64(double value) {
  std::array<std::byte, 8> raw{};
  protocol::detail::put64(raw.data(), std::bit_cast<std::uint64_t>(value));
  bytes_.insert(bytes_.end(), raw.begin(), raw.end());
}

void ByteWriter::text(std::string_view value) {
  u32(static_cast<std::uint32_t>(value.size()));
  for (const char c : value) u8(static_cast<std::uint8_t>(c));
}

std::span<const std::byte> ByteReader::take(std::size_t count) {
  static constexpr std::array<std::byte, 8> kZeros{};
  if (!has(count, 1)) return std::span(kZeros).first(count <= kZeros.size() ? count : 0);
  at_ += count;
  return bytes_.subspan(at_ - count, count);
}

bool ByteReader::has(std::uint64_t count, std::uint64_t size) {
  good_ = good_ && count <= left() / size;
  return good_;
}

std::uint8_t ByteReader::u8() { return protocol::detail::get8(take(1).data()); }

std::uint32_t ByteReader::u32() { return protocol::detail::get32(take(4).data()); }

float ByteReader::f32() { return std::bit_cast<float>(u32()); }

double ByteReader::f64() { return std::bit_cast<double>(protocol::detail::get64(take(8).data())); }

std::string ByteReader::text() {
  const std::uint32_t length = u32();
  std::string value;
  if (!has(length, 1)) return value;
  for (const std::byte b : take(length)) value.push_back(static_cast<char>(b));
  return value;
}

}  // namespace gridrt
