// .grt files: an image written and read back to the same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "host/image/image.hpp"

namespace gridrt {

/// Writes beside the target and renames, so a full disk leaves nothing half-written.
Result<void> write_image(const Image& image, const std::filesystem::path& path);

/// Reads and checks magic, version, sizes and every CRC; the error names the section and offset.
Result<Image> read_image(const std::filesystem::path& path);

/// Serialises to, and parses from, memory (the same bytes as the file).
std::vector<std::byte> serialize_image(const Image& image);
Result<Image> parse_image(std::span<const std::byte> bytes, const std::string& name);

/// The Header section as a device receives it: ImageHeader, directory, CRC-32C.
std::vector<std::byte> serialize_header(const Image& image);

/// Deep check beyond the CRCs: every index, reference, owner, id order, padding bit, count and
/// skip distance is what build_image would have written.
Result<void> verify_image(const Image& image);

/// The text of `gridrt-image --info`: sizes, lattice, grid, and per PE triangles, copies,
/// references, occupancy and balance.
std::string describe_image(const Image& image);

}  // namespace gridrt
