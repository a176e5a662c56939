// What kinds of vectors are called.
#pragma once

#include <cstdint>
#include <string_view>

#include <hwy/highway.h>

namespace gridrt {

/// baseline, sse4, avx2 or avx512; elsewhere Highway's name. `target`: one of Highway's bits.
inline std::string_view vector_name(std::int64_t target) {
  switch (target) {
#if HWY_ARCH_X86
    case HWY_AVX3:
      return "avx512";
    case HWY_AVX2:
      return "avx2";
    case HWY_SSE4:
      return "sse4";
#endif
    case HWY_EMU128:
    case HWY_SCALAR:
      return "baseline";
    default:
      return hwy::TargetName(target);
  }
}

}  // namespace gridrt
