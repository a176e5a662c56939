#include "host/app/parse.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "host/render/film.hpp"

namespace gridrt {
namespace {

std::unexpected<Error> refuse(std::string_view option, std::string_view text,
                              std::string_view expected) {
  return fail(ErrorKind::kUsage, fmt::format("{} {}: expected {}", option, text, expected));
}

// The whole of `text` as one number, or nothing.
template <class T>
std::optional<T> read(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Exactly `count` numbers with `separator` between them, or nothing.
template <class T>
std::optional<std::vector<T>> read_list(std::string_view text, char separator, std::size_t count) {
  std::vector<T> values;
  for (;;) {
    const std::size_t end = text.find(separator);
    const auto value = read<T>(text.substr(0, end));
    if (!value) return std::nullopt;
    values.push_back(*value);
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  if (values.size() != count) return std::nullopt;
  return values;
}

}  // namespace

Result<std::int64_t> parse_integer(std::string_view option, std::string_view text,
                                   std::int64_t least, std::int64_t most) {
  const auto value = read<std::int64_t>(text);
  if (!value || *value < least || *value > most) {
    return refuse(option, text,
                  most == std::numeric_limits<std::int64_t>::max()
                      ? fmt::format("a whole number of at least {}", least)
                      : fmt::format("a whole number from {} to {}", least, most));
  }
  return *value;
}

Result<double> parse_number(std::string_view option, std::string_view text) {
  const auto value = read<double>(text);
  if (!value || !std::isfinite(*value)) return refuse(option, text, "a finite number");
  return *value;
}

Result<glm::dvec3> parse_vector(std::string_view option, std::string_view text) {
  const auto v = read_list<double>(text, ',', 3);
  if (!v || !std::isfinite((*v)[0]) || !std::isfinite((*v)[1]) || !std::isfinite((*v)[2])) {
    return refuse(option, text, "three finite numbers such as 1,-2.5,3 (no spaces)");
  }
  return glm::dvec3((*v)[0], (*v)[1], (*v)[2]);
}

Result<glm::ivec2> parse_size(std::string_view option, std::string_view text) {
  const auto v = read_list<int>(text, 'x', 2);
  if (!v || (*v)[0] < 1 || (*v)[1] < 1 || (*v)[0] > kMaxPictureSide || (*v)[1] > kMaxPictureSide ||
      static_cast<std::uint64_t>((*v)[0]) * static_cast<std::uint64_t>((*v)[1]) >
          kMaxPicturePixels) {
    return refuse(option, text,
                  fmt::format("WIDTHxHEIGHT such as 640x480, sides from 1 to {}, at most {} pixels",
                              kMaxPictureSide, kMaxPicturePixels));
  }
  return glm::ivec2((*v)[0], (*v)[1]);
}

Result<glm::ivec2> parse_pixel(std::string_view option, std::string_view text) {
  const auto v = read_list<int>(text, ',', 2);
  if (!v || (*v)[0] < 0 || (*v)[1] < 0) {
    return refuse(option, text, "a pixel such as 320,240: column and row from the top left");
  }
  return glm::ivec2((*v)[0], (*v)[1]);
}

Result<std::optional<glm::ivec3>> parse_grid(std::string_view option, std::string_view text) {
  if (text == "auto") return std::nullopt;
  const auto v = read_list<int>(text, 'x', 3);
  if (!v || (*v)[0] < 1 || (*v)[1] < 1 || (*v)[2] < 1) {
    return refuse(option, text, "\"auto\" or voxels per axis such as 64x32x64");
  }
  return glm::ivec3((*v)[0], (*v)[1], (*v)[2]);
}

Result<int> parse_bits(std::string_view option, std::string_view text) {
  if (text == "auto") return kDefaultBits;
  const auto value = read<int>(text);
  if (!value || *value < kMinBits || *value > kMaxBits) {
    return refuse(option, text,
                  fmt::format("\"auto\" or a whole number from {} to {}", kMinBits, kMaxBits));
  }
  return *value;
}

Result<protocol::Layout> parse_layout(std::string_view option, std::string_view text) {
  if (text == "compact") return protocol::Layout::kCompact;
  if (text == "wide") return protocol::Layout::kWide;
  return refuse(option, text, "\"compact\" or \"wide\"");
}

std::string_view layout_name(protocol::Layout layout) {
  switch (layout) {
    case protocol::Layout::kCompact:
      return "compact";
    case protocol::Layout::kWide:
      return "wide";
    case protocol::Layout::kNone:
      break;
  }
  return "none";
}

}  // namespace gridrt
