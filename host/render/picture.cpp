#include "host/render/picture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <exception>
#include <string>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <fmt/format.h>
#include <png.h>

namespace gridrt {
namespace {

static_assert(std::endian::native == std::endian::little,
              "PFM and EXR rows are copied as they are");

std::vector<std::byte> to_bytes(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Result<std::vector<std::byte>> encode_png(const Film& film) {
  std::vector<png_byte> codes(film.pixels.size() * 3);
  for (std::size_t i = 0; i < film.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      codes[(3 * i) + static_cast<std::size_t>(c)] = srgb_code(film.pixels[i][c]);
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(film.width);
  image.height = static_cast<png_uint_32>(film.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, codes.data(), 0, nullptr) == 0) {
    return fail(ErrorKind::kInternal, fmt::format("PNG encoder: {}", image.message));
  }
  bytes.resize(size);
  return bytes;
}

Result<std::vector<std::byte>> encode_exr(const Film& film) {
  try {
    Imf::Header header(film.width, film.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char* channel : {"R", "G", "B"}) {
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    }
    Imf::StdOSStream stream;
    {
      Imf::OutputFile file(stream, header, 0);
      // The library takes non-const memory but only reads it when it writes a file.
      auto* base = reinterpret_cast<char*>(const_cast<glm::vec3*>(film.pixels.data()));
      const std::size_t row = sizeof(glm::vec3) * static_cast<std::size_t>(film.width);
      Imf::FrameBuffer frame;
      frame.insert("R", Imf::Slice(Imf::FLOAT, base, sizeof(glm::vec3), row));
      frame.insert("G", Imf::Slice(Imf::FLOAT, base + sizeof(float), sizeof(glm::vec3), row));
      frame.insert("B", Imf::Slice(Imf::FLOAT, base + (2 * sizeof(float)), sizeof(glm::vec3), row));
      file.setFrameBuffer(frame);
      file.writePixels(film.height);
    }
    return to_bytes(stream.str());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    return fail(ErrorKind::kInternal, fmt::format("EXR encoder: {}", error.what()));
  }
}

std::vector<std::byte> encode_pfm(const Film& film) {
  std::vector<std::byte> bytes =
      to_bytes(fmt::format("PF\n{} {}\n-1.0\n", film.width, film.height));
  const std::size_t width = static_cast<std::size_t>(film.width);
  bytes.reserve(bytes.size() + (film.pixels.size() * sizeof(glm::vec3)));
  for (std::size_t y = static_cast<std::size_t>(film.height); y-- > 0;) {
    const auto row = std::as_bytes(std::span(film.pixels).subspan(y * width, width));
    bytes.insert(bytes.end(), row.begin(), row.end());
  }
  return bytes;
}

}  // namespace

Result<PictureFormat> picture_format(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  if (ending == ".png") return PictureFormat::kPng;
  if (ending == ".exr") return PictureFormat::kExr;
  if (ending == ".pfm") return PictureFormat::kPfm;
  return fail(ErrorKind::kUsage,
              fmt::format("{}: no picture format has the ending \"{}\"", path.string(), ending),
              "use .png, .exr or .pfm");
}

std::uint8_t srgb_code(float linear) {
  const double x = linear > 0.0F ? std::min(static_cast<double>(linear), 1.0) : 0.0;
  const double encoded = x <= 0.0031308 ? 12.92 * x : (1.055 * std::pow(x, 1.0 / 2.4)) - 0.055;
  return static_cast<std::uint8_t>(std::lround(encoded * 255.0));
}

Result<std::vector<std::byte>> encode_picture(const Film& film, PictureFormat format) {
  switch (format) {
    case PictureFormat::kPng:
      return encode_png(film);
    case PictureFormat::kExr:
      return encode_exr(film);
    case PictureFormat::kPfm:
      return encode_pfm(film);
  }
  return fail(ErrorKind::kInternal, "unknown picture format");
}

}  // namespace gridrt
