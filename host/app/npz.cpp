#include "host/app/npz.hpp"

#include <memory>
#include <tuple>

#include <fmt/format.h>
#include <zip.h>

#include "host/app/npy.hpp"

namespace gridrt {
namespace {

struct FreeSource {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
struct DiscardArchive {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

std::unexpected<Error> refuse(std::string_view what) {
  return fail(ErrorKind::kInternal, fmt::format("ZIP library: {}", what));
}

Result<std::vector<std::byte>> read_source(zip_source_t* source) {
  zip_stat_t status;
  zip_stat_init(&status);
  if (zip_source_stat(source, &status) != 0 || (status.valid & ZIP_STAT_SIZE) == 0 ||
      zip_source_open(source) != 0) {
    return refuse("the archive cannot be read back");
  }
  std::vector<std::byte> bytes(status.size);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const zip_int64_t count = zip_source_read(source, bytes.data() + done, bytes.size() - done);
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  zip_source_close(source);
  if (done != bytes.size()) return refuse("the archive cannot be read back");
  return bytes;
}

}  // namespace

void NpzWriter::add_bytes(std::string_view name, std::string_view descr,
                          std::span<const std::uint64_t> shape, std::span<const std::byte> data) {
  std::string sides;
  for (const std::uint64_t side : shape) sides += fmt::format("{}, ", side);
  const std::string header = npy_header(fmt::format("'{}'", descr), "(" + sides + ")");
  const auto head = std::as_bytes(std::span(header));
  std::vector<std::byte> bytes;
  bytes.reserve(head.size() + data.size());
  bytes.insert(bytes.end(), head.begin(), head.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  members_.emplace_back(fmt::format("{}.npy", name), std::move(bytes));
}

Result<std::vector<std::byte>> NpzWriter::pack() const {
  std::unique_ptr<zip_source_t, FreeSource> target(
      zip_source_buffer_create(nullptr, 0, 0, nullptr));
  if (!target) return refuse("no memory");
  zip_source_keep(target.get());  // the archive takes one reference, this function another
  std::unique_ptr<zip_t, DiscardArchive> archive(
      zip_open_from_source(target.get(), ZIP_TRUNCATE, nullptr));
  if (!archive) {
    zip_source_free(target.get());
    return refuse("the archive cannot be opened");
  }
  for (const auto& [name, bytes] : members_) {
    zip_source_t* source = zip_source_buffer(archive.get(), bytes.data(), bytes.size(), 0);
    if (source == nullptr) return refuse(zip_strerror(archive.get()));
    const zip_int64_t index = zip_file_add(archive.get(), name.c_str(), source, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(source);
      return refuse(zip_strerror(archive.get()));
    }
    const auto entry = static_cast<zip_uint64_t>(index);
    constexpr zip_uint16_t kTime = 0;
    constexpr zip_uint16_t kDate = (1U << 5U) | 1U;  // 1980-01-01: the same bytes every day
    if (zip_set_file_compression(archive.get(), entry, ZIP_CM_STORE, 0) != 0 ||
        zip_file_set_dostime(archive.get(), entry, kTime, kDate, 0) != 0) {
      return refuse(zip_strerror(archive.get()));
    }
  }
  if (zip_close(archive.get()) != 0) return refuse(zip_strerror(archive.get()));
  std::ignore = archive.release();  // closing has freed it
  return read_source(target.get());
}

}  // namespace gridrt
