// Whole files: written beside the target and renamed, read at once.
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
  /// Closes now; 0 or the error number.
  int close() { return ::close(std::exchange(fd_, -1)) == 0 ? 0 : errno; }

 private:
  int fd_;
};

/// Writes all bytes; 0 or the error number.
int write_all(int fd, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return 0;
}

/// Header, sections and padding, to the disk; 0 or the error number.
int write_content(File& file, const Image& image) {
  constexpr std::array<std::byte, 4> kPadding{};
  int error = write_all(file.get(), header_section(image));
  for (const ImageSection& section : image.sections) {
    if (error == 0) error = write_all(file.get(), section.bytes);
    if (error == 0) {
      error = write_all(file.get(), std::span(kPadding).first((4 - section.bytes.size() % 4) % 4));
    }
  }
  if (error == 0 && ::fsync(file.get()) != 0) error = errno;
  const int close_error = file.close();
  return error != 0 ? error : close_error;
}

/// Makes the rename last: some file systems do not sync a directory, which is no failure of ours.
void sync_folder(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const File file(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (file.get() >= 0) ::fsync(file.get());
}

/// The mode of a new file under the present umask.
mode_t new_file_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

}  // namespace

Result<void> write_image(const Image& image, const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return file_error(path, "write", EISDIR);
  std::string temporary = path.string() + ".XXXXXX";
  File file(::mkstemp(temporary.data()));
  if (file.get() < 0) {
    return file_error(path, "write", errno, "check that the folder exists and can be written to");
  }
  int error = ::fchmod(file.get(), new_file_mode()) == 0 ? 0 : errno;
  if (error == 0) error = write_content(file, image);
  if (error == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    ::unlink(temporary.c_str());
    return file_error(path, "write", error,
                      error == ENOSPC ? "make room on the disk" : std::string{});
  }
  sync_folder(path);
  return {};
}

Result<Image> read_image(const std::filesystem::path& path) {
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
  return parse_image(bytes, path.string());
}

}  // namespace gridrt
