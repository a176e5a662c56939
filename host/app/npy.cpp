#include "host/app/npy.hpp"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <limits>
#include <system_error>

#include <fmt/format.h>

namespace gridrt {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are copied as they are");

// A reader of the few Python literals that such a header may hold.
class Literals {
 public:
  explicit Literals(std::string_view text) : rest_(text) {}

  bool take(char c) {
    skip_blanks();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  bool take_word(std::string_view word) {
    skip_blanks();
    if (!rest_.starts_with(word)) return false;
    rest_.remove_prefix(word.size());
    return true;
  }
  bool at(char c) {
    skip_blanks();
    return rest_.starts_with(c);
  }
  bool at_end() {
    skip_blanks();
    return rest_.empty();
  }
  bool text(std::string& value) {
    skip_blanks();
    if (rest_.empty() || (rest_.front() != '\'' && rest_.front() != '"')) return false;
    const std::size_t end = rest_.find(rest_.front(), 1);
    if (end == std::string_view::npos) return false;
    value = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    return true;
  }
  bool number(std::uint64_t& value) {
    skip_blanks();
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{}) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }
  // A bracketed value of which only the end matters.
  bool skip_brackets() {
    int depth = 0;
    std::string ignored;
    while (!at_end()) {
      if (text(ignored)) continue;
      const char c = rest_.front();
      rest_.remove_prefix(1);
      if (c == '[' || c == '(') ++depth;
      if ((c == ']' || c == ')') && --depth == 0) return true;
    }
    return false;
  }

 private:
  void skip_blanks() {
    const std::size_t first = rest_.find_first_not_of(" \t\r\n");
    rest_.remove_prefix(std::min(first, rest_.size()));
  }
  std::string_view rest_;
};

bool read_shape(Literals& in, std::vector<std::uint64_t>& shape) {
  if (!in.take('(')) return false;
  while (!in.take(')')) {
    std::uint64_t side = 0;
    if (!in.number(side)) return false;
    shape.push_back(side);
    if (!in.take(',') && !in.at(')')) return false;
  }
  return true;
}

std::unexpected<Error> at_path(ErrorKind kind, const std::filesystem::path& path,
                               std::string_view message, std::string advice = {}) {
  return fail(kind, fmt::format("{}: {}", path.string(), message), std::move(advice));
}

std::string system_message(int code) { return std::generic_category().message(code); }

std::string shape_text(const std::vector<std::uint64_t>& shape) {
  std::string text = "(";
  for (const std::uint64_t side : shape) text += fmt::format("{}, ", side);
  if (shape.size() > 1) text.resize(text.size() - 2);
  return text + ")";
}

Result<void> check_header(const std::filesystem::path& path, const NpyHeader& header) {
  if (header.descr != "<f8") {
    return at_path(ErrorKind::kInput, path,
                   header.descr.empty()
                       ? std::string("the array has a structured type, rays are float64")
                       : fmt::format("the array has type {}, rays are little-endian float64 (<f8)",
                                     header.descr),
                   "convert it: np.save(name, rays.astype('<f8'))");
  }
  if (header.shape.size() != 2 || (header.shape[1] != 6 && header.shape[1] != 8)) {
    return at_path(
        ErrorKind::kInput, path,
        fmt::format("the array has shape {}, rays have (N, 6) or (N, 8)", shape_text(header.shape)),
        "a row is origin x y z, direction x y z and, if given, tmin and tmax");
  }
  if (header.fortran_order) {
    return at_path(ErrorKind::kInput, path, "the array is in Fortran order, rays are in C order",
                   "convert it: np.save(name, np.ascontiguousarray(rays))");
  }
  return {};
}

}  // namespace

Result<NpyHeader> parse_npy_dictionary(std::string_view text) {
  const auto refuse = [](std::string_view message) {
    return fail(ErrorKind::kInput, fmt::format("the header is damaged: {}", message));
  };
  Literals in(text);
  NpyHeader header;
  bool has_descr = false;
  bool has_order = false;
  bool has_shape = false;
  if (!in.take('{')) return refuse("no dictionary");
  while (!in.take('}')) {
    std::string key;
    if (!in.text(key) || !in.take(':')) return refuse("no key");
    if (key == "descr" && !has_descr) {
      has_descr = true;
      if (!in.text(header.descr) && !(in.at('[') && in.skip_brackets())) return refuse("descr");
    } else if (key == "fortran_order" && !has_order) {
      has_order = true;
      header.fortran_order = in.take_word("True");
      if (!header.fortran_order && !in.take_word("False")) return refuse("fortran_order");
    } else if (key == "shape" && !has_shape) {
      has_shape = true;
      if (!read_shape(in, header.shape)) return refuse("shape");
    } else {
      return refuse(fmt::format("key '{}'", key));
    }
    if (!in.take(',') && !in.at('}')) return refuse("no comma");
  }
  if (!in.at_end()) return refuse("text after the dictionary");
  if (!has_descr || !has_order || !has_shape) {
    return refuse("descr, fortran_order or shape is missing");
  }
  return header;
}

std::string npy_header(std::string_view descr, std::string_view shape) {
  std::string text =
      fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}", descr, shape);
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kPrefix = 10;
  const std::size_t total = (kPrefix + text.size() + kAlignment) / kAlignment * kAlignment;
  text.append(total - kPrefix - text.size() - 1, ' ');
  text.push_back('\n');
  std::string out("\x93NUMPY\x01\x00", 8);
  out.push_back(static_cast<char>(text.size() & 0xFFU));
  out.push_back(static_cast<char>(text.size() >> 8U));
  return out + text;
}

Result<NpyRayReader> NpyRayReader::open(const std::filesystem::path& path) {
  NpyRayReader reader;
  reader.path_ = path;
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    return at_path(ErrorKind::kFile, path, "cannot be read: it is a directory");
  }
  // NOLINTNEXTLINE(cppcoreguidelines-owning-memory): owned at once by a unique_ptr that closes it
  reader.file_.reset(std::fopen(path.c_str(), "rbe"));
  if (!reader.file_) {
    return at_path(ErrorKind::kFile, path, "cannot be opened: " + system_message(errno));
  }
  const auto take = [&](void* to, std::size_t size) {
    return std::fread(to, 1, size, reader.file_.get()) == size;
  };
  std::array<unsigned char, 8> start{};
  if (!take(start.data(), start.size()) || std::memcmp(start.data(), "\x93NUMPY", 6) != 0) {
    return at_path(ErrorKind::kInput, path, "is not an .npy file",
                   "write it with np.save(name, rays), not np.savez or np.savetxt");
  }
  if (start[6] < 1 || start[6] > 3) {
    return at_path(ErrorKind::kInput, path,
                   fmt::format("version {}.{} of the format is not known", start[6], start[7]));
  }
  std::array<unsigned char, 4> length{};
  const std::size_t length_bytes = start[6] == 1 ? 2 : 4;
  if (!take(length.data(), length_bytes)) {
    return at_path(ErrorKind::kInput, path, "ends within its header");
  }
  std::uint32_t size = 0;
  for (std::size_t i = 0; i < length_bytes; ++i) size |= std::uint32_t{length[i]} << (8 * i);
  constexpr std::uint32_t kMaxHeader = 1U << 20U;
  if (size > kMaxHeader) {
    return at_path(ErrorKind::kInput, path, fmt::format("a header of {} bytes is absurd", size));
  }
  std::string text(size, '\0');
  if (!take(text.data(), text.size())) {
    return at_path(ErrorKind::kInput, path, "ends within its header");
  }
  auto header = parse_npy_dictionary(text);
  if (!header) return at_path(ErrorKind::kInput, path, header.error().message);
  if (auto checked = check_header(path, *header); !checked) {
    return std::unexpected(checked.error());
  }
  reader.count_ = header->shape[0];
  reader.columns_ = header->shape[1];
  constexpr std::uint64_t kMaxBytes = std::numeric_limits<std::int64_t>::max();
  if (reader.count_ > kMaxBytes / (reader.columns_ * sizeof(double))) {
    return at_path(ErrorKind::kInput, path, fmt::format("{} rows are absurd", reader.count_));
  }
  return reader;
}

Result<void> NpyRayReader::read(std::span<Ray> rays) {
  std::vector<double> row(columns_);
  for (Ray& ray : rays) {
    if (std::fread(row.data(), sizeof(double), columns_, file_.get()) != columns_) {
      if (std::ferror(file_.get()) != 0) {
        return at_path(ErrorKind::kFile, path_, "cannot be read: " + system_message(errno));
      }
      return at_path(ErrorKind::kInput, path_,
                     fmt::format("ends within row {}; its header promises {} rows", next_, count_));
    }
    ray = Ray{};
    ray.origin = {row[0], row[1], row[2]};
    ray.direction = {row[3], row[4], row[5]};
    if (columns_ == 8) {
      ray.tmin = row[6];
      ray.tmax = row[7];
    }
    if (auto valid = validate(ray); !valid) {
      return at_path(valid.error().kind, path_,
                     fmt::format("row {}: {}", next_, valid.error().message), valid.error().advice);
    }
    ++next_;
  }
  if (next_ == count_ && std::fgetc(file_.get()) != EOF) {
    return at_path(ErrorKind::kInput, path_,
                   fmt::format("goes on after the {} rows that its header promises", count_));
  }
  return {};
}

std::string hits_header(std::uint64_t count) {
  return npy_header("[('id', '<i4'), ('t', '<f8'), ('u', '<f8'), ('v', '<f8')]",
                    fmt::format("({},)", count));
}

Result<void> write_hits(OutputFile& file, std::span<const Hit> hits) {
  constexpr std::size_t kRow = sizeof(std::int32_t) + (3 * sizeof(double));
  std::vector<std::byte> bytes(hits.size() * kRow);
  std::byte* to = bytes.data();
  for (const Hit& hit : hits) {
    std::memcpy(to, &hit.id, sizeof(hit.id));
    std::memcpy(to + 4, &hit.t, sizeof(hit.t));
    std::memcpy(to + 12, &hit.u, sizeof(hit.u));
    std::memcpy(to + 20, &hit.v, sizeof(hit.v));
    to += kRow;
  }
  return file.write(bytes);
}

}  // namespace gridrt
