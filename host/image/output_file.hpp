// A file that appears whole or not at all: written beside its target and renamed when complete.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "hal/error.hpp"

namespace gridrt {

/// An output file in the making. Until commit() the target is untouched; a writer that is
/// destroyed before leaves nothing behind. A target that exists and is no regular file (a pipe, a
/// device such as /dev/stdout) is written directly; a symbolic link is followed and stays.
class OutputFile {
 public:
  OutputFile() = default;
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  ~OutputFile();

  /// Errors: kFile, naming the path and the reason.
  static Result<OutputFile> create(const std::filesystem::path& path);

  Result<void> write(std::span<const std::byte> bytes);
  Result<void> write(std::string_view text);

  /// Flushes to the disk and puts the file in its place. Nothing may be written afterwards.
  Result<void> commit();

  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  void discard() noexcept;
  [[nodiscard]] std::unexpected<Error> failure(std::string_view what, int code) const;

  /// Finds a free name beside the target for `make` to create; 0 or the errno of the failure.
  template <class Make>
  int name_temporary(const Make& make);

  int descriptor_ = -1;
  bool direct_ = false;              ///< the target itself is being written
  std::filesystem::path path_;       ///< as the user named it
  std::filesystem::path target_;     ///< path_ with symbolic links followed
  std::filesystem::path temporary_;  ///< name beside the target, empty while there is none
};

/// Creates, writes and commits in one go.
Result<void> write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace gridrt
