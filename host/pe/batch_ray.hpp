// A ray of a batch.
#pragma once

#include "host/pe/pe.hpp"

namespace gridrt {

/// A ray as it came, in either layout.
struct BatchRay {
  PeRay ray;
  bool any_hit = false;
};

}  // namespace gridrt
