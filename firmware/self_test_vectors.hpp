// The self-test's vectors of one kind of board, made by make_vectors.cpp during the build.
#pragma once

#include "firmware/firmware.hpp"

namespace gridrt::firmware {

extern const SelfTestVectors kSelfTestVectors;

}  // namespace gridrt::firmware
