// What the device decides about the images that it gets.
#pragma once

#include "host/image/image.hpp"

namespace gridrt {

/// The layout to use with a device: wide where it speaks it, else compact.
protocol::Layout preferred_layout(const protocol::CapabilitiesReport& capabilities);

/// `options` with the device's memory sizes, and with its layout where none was chosen.
ImageOptions options_for(ImageOptions options, const protocol::CapabilitiesReport& capabilities);

}  // namespace gridrt
