// The header of a PLY file: which elements follow, with which properties, in which encoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"

namespace gridrt::scene_detail {

enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

/// Bytes of a value in the binary encodings.
std::size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  std::optional<PlyType> count_type;  ///< of a list; none for a single value
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Position of a property by name, if there is one.
  std::optional<std::size_t> find(std::string_view property) const;
  /// Least bytes that one element of this kind takes in the file.
  std::uint64_t least_bytes(PlyEncoding encoding) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::size_t lines = 0;      ///< of the header, end_header included
  std::size_t body_from = 0;  ///< offset of the first byte after the header
};

/// Reads the header at the start of `bytes`. Errors name `name` and line: not a PLY file, an
/// unknown statement, type or encoding, two elements of one name, more elements than the rest of
/// the file could hold.
Result<PlyHeader> read_ply_header(std::string_view bytes, const std::string& name);

}  // namespace gridrt::scene_detail
