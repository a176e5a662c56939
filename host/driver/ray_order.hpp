// In which order the rays of a call go to a device.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace gridrt {

/// A stride A in [1, max(1, n)), coprime to n and near n (3 - sqrt 5) / 2, about 0.38 n: the steps
/// 0, A, 2 A, ... mod n visit every number below n once, and no few consecutive ones are close to
/// each other (the golden section keeps multiples apart best).
std::size_t spreading_stride(std::size_t n);

/// `places` in that order. Rays that are neighbours in a picture meet the same voxels, so that in a
/// device that works on many rays at once they wait for the same PE; spread ones do not.
std::vector<std::size_t> spread(std::span<const std::size_t> places);

}  // namespace gridrt
