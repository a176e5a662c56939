// Numbers that longer runs of a bench get from outside.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace gridrt {

/// What an environment variable says, or a value if it is not set.
inline std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

}  // namespace gridrt
