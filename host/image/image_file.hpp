// .grt files: an image written and read back to the same bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/image/image.hpp"

namespace gridrt {

/// Writes beside the target and renames, so a full disk leaves nothing half-written. Errors: kFile
/// with what the system said.
Result<void> write_image(const Image& image, const std::filesystem::path& path);

/// A whole file. Errors: kFile if it cannot be read.
Result<std::vector<std::byte>> read_bytes(const std::filesystem::path& path);

/// Reads a file and parses it. Errors: kFile if it cannot be read, kInput as parse_image.
Result<Image> read_image(const std::filesystem::path& path);

/// The Header section: ImageHeader, the directory with every section's CRC, and a CRC-32C over
/// both. A .grt starts with it, and a device receives it first.
std::vector<std::byte> header_section(const Image& image);

/// Serialises to, and parses from, memory (the same bytes as the file). Sections follow each other
/// without gaps, each padded with zeros to a multiple of 4. parse_image checks all that can be
/// checked without decoding records: magic, versions, reserved fields, the directory, that every
/// section is there once, its place, padding and CRC; the error names `name`, section and offset.
std::vector<std::byte> serialize_image(const Image& image);
Result<Image> parse_image(std::span<const std::byte> bytes, const std::string& name);

/// Deep check beyond the CRCs: every index, reference, owner, id order, padding bit, count and
/// skip distance is what build_image would have written.
Result<void> verify_image(const Image& image);

/// The text of `gridrt-image --info`: sizes, lattice, grid, and per PE triangles, copies,
/// references, occupancy and balance.
std::string describe_image(const Image& image);

}  // namespace gridrt
