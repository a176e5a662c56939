#include "host/driver/image_options.hpp"

namespace gridrt {

protocol::Layout preferred_layout(const protocol::CapabilitiesReport& capabilities) {
  constexpr auto kWideBit = static_cast<unsigned>(protocol::Layout::kWide);
  return ((capabilities.layouts >> kWideBit) & 1U) != 0 ? protocol::Layout::kWide
                                                        : protocol::Layout::kCompact;
}

ImageOptions options_for(ImageOptions options, const protocol::CapabilitiesReport& capabilities) {
  if (options.layout == protocol::Layout::kNone) options.layout = preferred_layout(capabilities);
  options.memory = memory_sizes(capabilities);
  return options;
}

}  // namespace gridrt
