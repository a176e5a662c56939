// Images as whole files: written beside the target and renamed, read at once.
#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/image/image_file.hpp"
#include "host/image/output_file.hpp"

namespace gridrt {
namespace {

std::unexpected<Error> file_error(const std::filesystem::path& path, std::string_view what,
                                  int code, std::string advice = {}) {
  return fail(
      ErrorKind::kFile,
      fmt::format("{}: cannot {}: {}", path.string(), what, std::generic_category().message(code)),
      std::move(advice));
}

/// A file descriptor that is closed at the end of its life.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

}  // namespace

Result<void> write_image(const Image& image, const std::filesystem::path& path) {
  constexpr std::array<std::byte, 4> kPadding{};
  auto file = OutputFile::create(path);
  if (!file) return std::unexpected(file.error());
  Result<void> written = file->write(header_section(image));
  for (const ImageSection& section : image.sections) {
    if (written) written = file->write(section.bytes);
    if (written) {
      written = file->write(std::span(kPadding).first((4 - section.bytes.size() % 4) % 4));
    }
  }
  return written ? file->commit() : written;
}

Result<std::vector<std::byte>> read_bytes(const std::filesystem::path& path) {
  const File file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) return file_error(path, "open", errno);
  struct stat info{};
  if (::fstat(file.get(), &info) != 0) return file_error(path, "read", errno);
  if (S_ISDIR(info.st_mode)) return file_error(path, "read", EISDIR);
  constexpr std::size_t kPiece = 1U << 20U;
  std::vector<std::byte> bytes(static_cast<std::size_t>(info.st_size) + 1);
  std::size_t size = 0;
  while (true) {
    if (size == bytes.size()) bytes.resize(size + kPiece);
    const ssize_t count = ::read(file.get(), bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return file_error(path, "read", errno);
    if (count == 0) break;
    size += static_cast<std::size_t>(count);
  }
  bytes.resize(size);
  return bytes;
}

Result<Image> read_image(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  if (!bytes) return std::unexpected(bytes.error());
  return parse_image(*bytes, path.string());
}

}  // namespace gridrt
