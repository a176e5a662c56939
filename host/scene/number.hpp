// Numbers from text: the nearest float32 or float64 of a decimal, whatever the locale.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/error.hpp"

namespace gridrt::scene_detail {

/// The float32 nearest to the decimal `token` (ties to even; underflow gives a denormal or zero of
/// the right sign). Errors (kInput, no place in the message): not a number, NaN or infinite, or
/// beyond float32's range.
Result<float> parse_float(std::string_view token);

/// The same for float64.
Result<double> parse_double(std::string_view token);

/// A whole decimal integer that fits; nothing if `token` is anything else.
std::optional<std::int64_t> parse_integer(std::string_view token);

}  // namespace gridrt::scene_detail
