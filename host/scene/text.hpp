// Lines and tokens of text formats, without copies; linear in the text however long a line is.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace gridrt::scene_detail {

/// Splits off and returns the next token of `line` (separated by blanks and tabs), empty at its
/// end.
std::string_view next_token(std::string_view& line);

/// `text` without blanks and tabs on both sides.
std::string_view trim(std::string_view text);

/// Printable start of a token for a message, at most 40 characters.
std::string shorten(std::string_view token);

/// Reads lines that end in LF, CR LF or CR; a backslash before the end joins the next line, if
/// asked for.
class LineReader {
 public:
  explicit LineReader(std::string_view text, bool join_lines = false)
      : rest_(text), join_lines_(join_lines) {}

  /// The next line without its end, or nothing at the end of the text. The view is valid until the
  /// next call.
  std::optional<std::string_view> next();

  /// Number of the line last returned, from 1; of its first part if lines were joined.
  std::size_t number() const { return number_; }

  /// What has not been read yet (for binary data after a text header).
  std::string_view rest() const { return rest_; }

 private:
  std::string_view take();

  std::string_view rest_;
  bool join_lines_;
  std::string joined_;
  std::size_t number_ = 0;
  std::size_t lines_taken_ = 0;
};

}  // namespace gridrt::scene_detail
