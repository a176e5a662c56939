// Memory that is read at random: a table of pages that does not fit the processor's is as slow as
// memory itself, so large arrays ask for large pages.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

#include <sys/mman.h>

namespace gridrt {

/// Of std::vector. Where the system has no large pages, ordinary ones.
template <class T>
struct LargePages {
  using value_type = T;
  LargePages() = default;
  template <class U>
  explicit LargePages(const LargePages<U>& /*other*/) {}

  static constexpr std::size_t kPage = std::size_t{1} << 21;
  static constexpr std::size_t kSmall = kPage / 2;  ///< less than this is not worth a page

  [[nodiscard]] T* allocate(std::size_t n) {
    const std::size_t bytes = n * sizeof(T);
    void* const memory = ::operator new(bytes, alignment(bytes));
    if (bytes >= kSmall) static_cast<void>(madvise(memory, bytes, MADV_HUGEPAGE));
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t n) noexcept {
    ::operator delete(memory, alignment(n * sizeof(T)));
  }
  friend bool operator==(const LargePages& /*a*/, const LargePages& /*b*/) { return true; }

 private:
  static std::align_val_t alignment(std::size_t bytes) {
    return std::align_val_t{bytes >= kSmall ? kPage : alignof(T) < 64 ? 64 : alignof(T)};
  }
};

template <class T>
using LargeVector = std::vector<T, LargePages<T>>;

}  // namespace gridrt
