#include "host/image/output_file.hpp"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gridrt {
namespace {

namespace fs = std::filesystem;

// Follows symbolic links even where the last one dangles, so that the link itself survives.
fs::path follow_links(fs::path path) {
  constexpr int kMaxLinks = 40;
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i) {
    const fs::path next = fs::read_symlink(path, error);
    if (error) break;
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

std::string advice_for(int code) {
  switch (code) {
    case ENOENT:
      return "create the directory first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a place that you may write to";
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free some space or choose another disk; nothing was left behind";
    default:
      return {};
  }
}

/// Makes a rename last: some file systems do not sync a directory, which is no failure of ours.
void sync_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

std::string name_of(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

}  // namespace

OutputFile::OutputFile(OutputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      direct_(other.direct_),
      path_(std::move(other.path_)),
      target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)) {
  other.temporary_.clear();
}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    discard();
    descriptor_ = std::exchange(other.descriptor_, -1);
    direct_ = other.direct_;
    path_ = std::move(other.path_);
    target_ = std::move(other.target_);
    temporary_ = std::move(other.temporary_);
    other.temporary_.clear();
  }
  return *this;
}

OutputFile::~OutputFile() { discard(); }

void OutputFile::discard() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  temporary_.clear();
}

std::unexpected<Error> OutputFile::failure(std::string_view what, int code) const {
  return fail(
      ErrorKind::kFile,
      fmt::format("cannot {} {}: {}", what, path_.string(), std::generic_category().message(code)),
      advice_for(code));
}

template <class Make>
int OutputFile::name_temporary(const Make& make) {
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : ".";
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    fs::path name = folder / fmt::format(".gridrt-{}-{}", ::getpid(), i);
    if (make(name)) {
      temporary_ = std::move(name);
      return 0;
    }
    if (errno != EEXIST) return errno;
  }
  return EEXIST;
}

Result<OutputFile> OutputFile::create(const fs::path& path) {
  OutputFile file;
  file.path_ = path;
  file.target_ = follow_links(path);
  if (path.empty()) return fail(ErrorKind::kUsage, "the name of an output file is empty");
  struct stat status{};
  if (::stat(file.target_.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) return file.failure("write", EISDIR);
    if (!S_ISREG(status.st_mode)) {
      file.direct_ = true;
      file.descriptor_ = ::open(file.target_.c_str(), O_WRONLY | O_CLOEXEC);
      if (file.descriptor_ < 0) return file.failure("open", errno);
      return file;
    }
    // A rename would replace a file that its owner has made read-only.
    if (::access(file.target_.c_str(), W_OK) != 0) return file.failure("write", errno);
  } else if (errno != ENOENT) {
    return file.failure("write", errno);
  }
  const fs::path folder = file.target_.has_parent_path() ? file.target_.parent_path() : ".";
  // A file without a name vanishes even if the program is killed.
  file.descriptor_ = ::open(folder.c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666);
  if (file.descriptor_ >= 0 && ::access(name_of(file.descriptor_).c_str(), F_OK) == 0) return file;
  if (file.descriptor_ >= 0) ::close(file.descriptor_);  // no /proc, so it could not be named later
  const auto make = [&](const fs::path& name) {
    file.descriptor_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    return file.descriptor_ >= 0;
  };
  if (const int code = file.name_temporary(make); code != 0) return file.failure("create", code);
  return file;
}

Result<void> OutputFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0) {
      if (errno == EINTR) continue;
      const int code = errno;
      discard();
      return failure("write", code);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return {};
}

Result<void> OutputFile::write(std::string_view text) {
  return write(std::as_bytes(std::span(text)));
}

Result<void> OutputFile::commit() {
  int code = 0;
  if (!direct_) {
    // A file that is replaced hands down its rights.
    struct stat status{};
    if (::stat(target_.c_str(), &status) == 0 &&
        ::fchmod(descriptor_, status.st_mode & 07777U) != 0 && errno != EPERM) {
      code = errno;
    }
    if (code == 0 && ::fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) code = errno;
  }
  if (code == 0 && !direct_ && temporary_.empty()) {
    const std::string open_file = name_of(descriptor_);
    code = name_temporary([&](const fs::path& name) {
      return ::linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
    });
  }
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0 && errno != EINTR && code == 0) code = errno;
  if (code == 0 && !direct_ && ::rename(temporary_.c_str(), target_.c_str()) != 0) code = errno;
  if (code != 0) {
    discard();
    return failure("write", code);
  }
  temporary_.clear();
  if (!direct_) sync_folder(target_);
  return {};
}

Result<void> write_file(const fs::path& path, std::span<const std::byte> bytes) {
  auto file = OutputFile::create(path);
  if (!file) return std::unexpected(file.error());
  if (auto written = file->write(bytes); !written) return written;
  return file->commit();
}

}  // namespace gridrt
