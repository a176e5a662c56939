// .npz archives: several .npy arrays in a ZIP file, stored without compression.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ranges>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/error.hpp"

namespace gridrt {

/// Collects arrays and packs them; the same arrays give the same bytes.
class NpzWriter {
 public:
  /// Adds array `name` of elements `descr` (such as <i4) with `shape`; `data` is copied. Its size
  /// must be the product of the shape times the element's size.
  template <std::ranges::contiguous_range Range>
  void add(std::string_view name, std::string_view descr, std::span<const std::uint64_t> shape,
           const Range& data) {
    add_bytes(name, descr, shape,
              std::as_bytes(std::span(std::ranges::data(data), std::ranges::size(data))));
  }

  /// The bytes of the archive. Errors: kInternal from the ZIP library.
  [[nodiscard]] Result<std::vector<std::byte>> pack() const;

 private:
  void add_bytes(std::string_view name, std::string_view descr,
                 std::span<const std::uint64_t> shape, std::span<const std::byte> data);

  std::vector<std::pair<std::string, std::vector<std::byte>>> members_;
};

}  // namespace gridrt
