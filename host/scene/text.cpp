#include "host/scene/text.hpp"

#include <algorithm>

namespace gridrt::scene_detail {
namespace {
constexpr std::string_view kBlanks = " \t\v\f";
}

std::string_view next_token(std::string_view& line) {
  const std::size_t first = line.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    line = {};
    return {};
  }
  line.remove_prefix(first);
  const std::size_t length = std::min(line.find_first_of(kBlanks), line.size());
  const std::string_view token = line.substr(0, length);
  line.remove_prefix(length);
  return token;
}

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string shorten(std::string_view token) {
  constexpr std::size_t kShown = 40;
  std::string text;
  for (const char c : token.substr(0, kShown)) {
    text += (c >= ' ' && c <= '~') ? c : '?';
  }
  return token.size() > kShown ? text + "..." : text;
}

std::string_view LineReader::take() {
  const std::size_t end = rest_.find_first_of("\r\n");
  const std::string_view line = rest_.substr(0, end);
  if (end == std::string_view::npos) {
    rest_ = {};
  } else {
    rest_.remove_prefix(rest_.substr(end).starts_with("\r\n") ? end + 2 : end + 1);
  }
  ++lines_taken_;
  return line;
}

std::optional<std::string_view> LineReader::next() {
  if (rest_.empty()) {
    return std::nullopt;
  }
  std::string_view line = take();
  number_ = lines_taken_;
  if (!join_lines_ || !line.ends_with('\\')) {
    return line;
  }
  joined_.clear();
  while (line.ends_with('\\')) {
    joined_ += line.substr(0, line.size() - 1);
    joined_ += ' ';
    if (rest_.empty()) {
      return joined_;
    }
    line = take();
  }
  joined_ += line;
  return joined_;
}

}  // namespace gridrt::scene_detail
