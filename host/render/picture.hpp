// Picture files: PNG (8-bit sRGB), OpenEXR (32-bit linear) and PFM (32-bit linear).
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "hal/error.hpp"
#include "host/image/output_file.hpp"
#include "host/render/film.hpp"

namespace gridrt {

enum class PictureFormat { kPng, kExr, kPfm };

/// The format that a file name's ending asks for, in either case. Errors: kUsage, listing the
/// endings that are known.
Result<PictureFormat> picture_format(const std::filesystem::path& path);

/// Linear light in [0, 1] (clamped; not a number counts as 0) to an 8-bit sRGB code, by the
/// transfer function of IEC 61966-2-1 rounded to nearest.
std::uint8_t srgb_code(float linear);

/// The bytes of a picture file; the same film gives the same bytes. EXR and PFM keep values
/// beyond [0, 1]; PFM rows run from the bottom up, as its definition has it.
Result<std::vector<std::byte>> encode_picture(const Film& film, PictureFormat format);

}  // namespace gridrt
