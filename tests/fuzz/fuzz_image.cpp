// Decoders of images: on the input as a file, on the input as a Scene section, and on a small good
// image that the input changes here and there, with every CRC made right again. Nothing may crash,
// and what the deep check lets pass with an unchanged scene must be the image that was built.
#include <algorithm>
#include <cstdlib>

#include "host/image/image_file.hpp"
#include "host/image/scene_section.hpp"

namespace {

using gridrt::Image;
using gridrt::protocol::ImageHeader;

void require(bool condition) {
  if (!condition) std::abort();
}

/// A few triangles, one degenerate, in two PEs.
gridrt::Scene small_scene() {
  gridrt::Scene scene;
  scene.materials.emplace_back();
  scene.lights.emplace_back();
  scene.camera.emplace();
  scene.normals.emplace_back(0.0F, 0.0F, 1.0F);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const float x = static_cast<float>(i % 3) * 0.4F;
    const float y = static_cast<float>(i / 3);
    const auto base = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.emplace_back(x, y, 0.0F);
    scene.positions.emplace_back(x + 0.3F, y, 0.1F);
    scene.positions.emplace_back(x, y + (i == 4 ? 0.0F : 0.2F), i == 4 ? 0.0F : 0.3F);
    scene.triangles.push_back({base, base + 1, base + 2});
    scene.triangle_normals.push_back({0, 0, 0});
    scene.triangle_materials.push_back(0);
  }
  return scene;
}

Image small_image(gridrt::protocol::Layout layout, bool with_scene) {
  gridrt::ImageOptions options;
  options.layout = layout;
  options.pes = 2;
  options.grid = glm::ivec3{5, 4, 2};
  options.with_scene = with_scene;
  auto image = gridrt::build_image(small_scene(), options);
  require(image.has_value());
  return std::move(*image);
}

/// The input as a row of choices.
class Input {
 public:
  explicit Input(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  [[nodiscard]] bool empty() const { return at_ >= bytes_.size(); }
  std::size_t byte() { return empty() ? 0 : bytes_[at_++]; }
  std::size_t word() {
    const std::size_t low = byte();
    return low + 256 * byte();
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

void change(Image& image, Input& input) {
  const std::size_t choice = input.byte();
  const std::size_t value = input.byte();
  if (choice % 4 == 0) {
    std::array<std::byte, ImageHeader::kBytes> raw{};
    store(image.header, raw);
    raw[input.byte() % raw.size()] ^= static_cast<std::byte>(value);
    image.header = gridrt::protocol::load_image_header(raw);
    return;
  }
  gridrt::ImageSection& section = image.sections[choice / 4 % image.sections.size()];
  if (choice % 4 == 1) {
    section.bytes.resize(std::max<std::size_t>(section.bytes.size() + value, 128) - 128);
  } else if (choice % 4 == 2 && value == 255) {
    section.pe ^= static_cast<std::uint8_t>(input.byte());
  } else if (!section.bytes.empty()) {
    section.bytes[input.word() % section.bytes.size()] ^= static_cast<std::byte>(value);
  }
}

/// Runs every decoder.
void decode(const Image& image) {
  const auto triangles = gridrt::decode_triangles(image);
  if (triangles) require(triangles->triangles.size() == image.header.local_ids);
  const auto scene = gridrt::decode_scene(image);
  if (scene) require(scene->triangles.size() == image.header.triangles);
  require(!gridrt::describe_image(image).empty());
}

void try_changed(Input& input) {
  using gridrt::protocol::Layout;
  // Built once: an input may cost only what it changes.
  static const std::array<Image, 4> images = {
      small_image(Layout::kWide, true), small_image(Layout::kCompact, true),
      small_image(Layout::kWide, false), small_image(Layout::kCompact, false)};
  const Image& good = images[input.byte() % images.size()];
  Image image = good;
  while (!input.empty()) change(image, input);
  image.header.sections = static_cast<std::uint16_t>(image.sections.size());  // as written
  const bool verified = gridrt::verify_image(image).has_value();
  decode(image);
  const std::vector<std::byte> bytes = gridrt::serialize_image(image);
  const auto parsed = gridrt::parse_image(bytes, "fuzz");
  if (!parsed) return;
  // All of an image is in its bytes, so the deep check says the same of both.
  require(gridrt::serialize_image(*parsed) == bytes);
  // With its scene as it was, an image that passes is the one that was built.
  const auto* scene = image.find(gridrt::protocol::SectionKind::kScene);
  const auto* good_scene = good.find(gridrt::protocol::SectionKind::kScene);
  if (verified && scene != nullptr && good_scene != nullptr && scene->bytes == good_scene->bytes) {
    require(bytes == gridrt::serialize_image(good));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input({data, size});
  const auto bytes = std::as_bytes(std::span(data, size));
  switch (input.byte() % 8) {
    case 0:
      if (const auto image = gridrt::parse_image(bytes.subspan(size == 0 ? 0 : 1), "fuzz")) {
        decode(*image);
      }
      break;
    case 1:
      if (const auto scene = gridrt::unpack_scene(bytes.subspan(1))) {
        const auto again = gridrt::pack_scene(*scene);
        require(again && std::ranges::equal(*again, bytes.subspan(1)));
      }
      break;
    default:
      try_changed(input);
  }
  return 0;
}
