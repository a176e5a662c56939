// NumPy's .npy files: rays in, hits out (format: numpy.lib.format, versions 1.0 to 3.0).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/error.hpp"
#include "host/driver/device.hpp"
#include "host/grid/segment.hpp"
#include "host/image/output_file.hpp"

namespace gridrt {

/// What the header of an .npy file says.
struct NpyHeader {
  std::string descr;  ///< type of an element, such as <f8; empty for a structured type
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
};

/// Reads the dictionary that stands in an .npy header. Errors: kInput without a place.
Result<NpyHeader> parse_npy_dictionary(std::string_view text);

/// The magic, version 1.0 and header of an array; `descr` and `shape` are Python literals. Padded
/// so that the data starts on a multiple of 64 bytes.
std::string npy_header(std::string_view descr, std::string_view shape);

/// Rays from an array of float64, little endian, C order, shape (N, 6): origin and direction, or
/// (N, 8): also tmin and tmax (else 0 and infinity). Reads forward, so pipes work too.
class NpyRayReader {
 public:
  /// Errors: kFile, or kInput for content that is anything else, with advice on how to convert it.
  static Result<NpyRayReader> open(const std::filesystem::path& path);

  /// Rows that the header promises.
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// The next rays.size() rows. Errors: kFile, kInput for a file that ends early or goes on beyond
  /// its last row, and for a row that is not a valid ray, naming the row (from 0).
  Result<void> read(std::span<Ray> rays);

 private:
  struct Close {
    // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): the deleter of the handle's owner
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::uint64_t count_ = 0;
  std::uint64_t next_ = 0;
  std::size_t columns_ = 0;
};

/// The header of a hits file of `count` rows: packed structured id (int32), t, u, v (float64).
std::string hits_header(std::uint64_t count);

/// Appends rows of 28 bytes.
Result<void> write_hits(OutputFile& file, std::span<const Hit> hits);

}  // namespace gridrt
