#include "host/scene/number.hpp"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/format.h>

#include "host/scene/text.hpp"

namespace gridrt::scene_detail {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// True if the decimal `token`, known to be well formed and out of range, is too small rather than
// too large: its first significant digit stands right of the point.
bool underflows(std::string_view token) {
  const std::size_t e = token.find_first_of("eE");
  const std::string_view mantissa = token.substr(0, e);
  std::int64_t exponent = 0;
  if (e != std::string_view::npos) {
    std::string_view digits = token.substr(e + 1);
    const bool negative = digits.starts_with('-');
    if (negative || digits.starts_with('+')) {
      digits.remove_prefix(1);
    }
    constexpr std::int64_t kHuge = 1'000'000'000'000;
    const auto result = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    if (result.ec != std::errc{} || exponent > kHuge) {
      exponent = kHuge;
    }
    exponent = negative ? -exponent : exponent;
  }
  const std::size_t point = mantissa.find('.');
  const std::size_t units = point == std::string_view::npos ? mantissa.size() : point;
  const std::size_t first = mantissa.find_first_of("123456789");
  if (first == std::string_view::npos) {
    return true;
  }
  return static_cast<std::int64_t>(units) - static_cast<std::int64_t>(first) + exponent <= 0;
}

template <class T>
Result<T> parse_real(std::string_view token, const char* type) {
  std::string_view text = token;
  // from_chars takes no plus sign, files do.
  if (text.starts_with('+') && text.size() > 1 && (is_digit(text[1]) || text[1] == '.')) {
    text.remove_prefix(1);
  }
  T value{};
  const char* begin = text.data();
  const char* end = begin + text.size();
  const auto result = std::from_chars(begin, end, value);
  if (result.ec == std::errc::invalid_argument || result.ptr != end) {
    return fail(ErrorKind::kInput, fmt::format("'{}' is not a number", shorten(token)));
  }
  if (result.ec == std::errc::result_out_of_range) {
    if (underflows(text)) {
      return text.starts_with('-') ? -T{0} : T{0};
    }
    return fail(ErrorKind::kInput,
                fmt::format("'{}' is beyond the range of {}", shorten(token), type));
  }
  if (!std::isfinite(value)) {
    return fail(ErrorKind::kInput, fmt::format("'{}' is not a finite number in the range of {}",
                                               shorten(token), type));
  }
  return value;
}

}  // namespace

Result<float> parse_float(std::string_view token) { return parse_real<float>(token, "float32"); }

Result<double> parse_double(std::string_view token) { return parse_real<double>(token, "float64"); }

std::optional<std::int64_t> parse_integer(std::string_view token) {
  if (token.starts_with('+') && token.size() > 1 && is_digit(token[1])) {
    token.remove_prefix(1);
  }
  std::int64_t value = 0;
  const char* begin = token.data();
  const char* end = begin + token.size();
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc{} || result.ptr != end) {
    return std::nullopt;
  }
  return value;
}

}  // namespace gridrt::scene_detail
