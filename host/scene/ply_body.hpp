// The values of a PLY file after its header, in either encoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/error.hpp"
#include "host/scene/ply_header.hpp"
#include "host/scene/text.hpp"

namespace gridrt::scene_detail {

/// One value of the body: the number that a binary file holds, or the text itself, which is parsed
/// as what it is needed for, so that a coordinate is rounded once.
struct PlyValue {
  double number = 0.0;
  std::string_view text;
};

/// Hands out the values of the body one after the other. Errors (kInput) name the element and its
/// line or byte: the file ends, a value is not what it should be.
class PlyBody {
 public:
  PlyBody(std::string_view bytes, const PlyHeader& header, const std::string& name);

  /// Begins an element: a line of its own in text files.
  Result<void> begin(const PlyElement& element, std::uint64_t number);
  /// Ends it: a text line has no further values.
  Result<void> end() const;

  Result<PlyValue> next(PlyType type);
  /// A value as the nearest float32; refuses NaN, infinity and what is beyond its range.
  Result<float> real(const PlyValue& value) const;
  Result<std::int64_t> integer(const PlyValue& value) const;
  /// Reads the length of a list; never more than the rest of the file can hold.
  Result<std::uint64_t> list_length(const PlyProperty& property);
  /// Reads over a value or a list.
  Result<void> skip(const PlyProperty& property);

  /// True if anything but blank lines is left.
  bool has_more();

  /// An error at the present element.
  std::unexpected<Error> bad(const std::string& what) const;

 private:
  double binary(PlyType type) const;

  std::string_view bytes_;
  LineReader lines_;
  PlyEncoding encoding_;
  std::size_t first_line_;
  const std::string& name_;
  std::string_view line_;
  std::size_t offset_ = 0;
  std::string element_;
  std::uint64_t number_ = 0;
};

}  // namespace gridrt::scene_detail
