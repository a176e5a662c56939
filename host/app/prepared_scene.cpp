#include "host/app/prepared_scene.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "host/app/parse.hpp"
#include "host/driver/image_options.hpp"
#include "host/image/image_file.hpp"
#include "host/scene/load.hpp"

namespace gridrt {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_between(Clock::time_point start, Clock::time_point end) {
  return std::chrono::duration<double>(end - start).count();
}

Result<void> check_against(const std::string& path, const CutOptions& cut, const Image& image) {
  const auto refuse = [&path](std::string_view option, const auto& wanted, const auto& held) {
    return fail(ErrorKind::kUsage,
                fmt::format("{} {}: {} was made with {}", option, wanted, path, held),
                "leave the option out, or make the image anew with gridrt-image");
  };
  const auto& header = image.header;
  if (cut.bits && *cut.bits != header.bits) return refuse("--bits", *cut.bits, header.bits);
  if (cut.pes && *cut.pes != header.pes) return refuse("--pes", *cut.pes, header.pes);
  const glm::ivec3 count = image.grid().count;
  if (cut.grid && *cut.grid != count) {
    return refuse("--grid", fmt::format("{}x{}x{}", cut.grid->x, cut.grid->y, cut.grid->z),
                  fmt::format("{}x{}x{}", count.x, count.y, count.z));
  }
  const auto layout = static_cast<protocol::Layout>(header.layout);
  if (cut.layout && *cut.layout != layout) {
    return refuse("--layout", layout_name(*cut.layout), layout_name(layout));
  }
  const auto mapping = static_cast<Mapping>(header.mapping);
  // Measured boxes are plain ones where there was nothing to measure.
  if (cut.mapping && *cut.mapping != mapping &&
      (*cut.mapping != Mapping::kMeasured || mapping != Mapping::kBoxes)) {
    return refuse("--mapping", mapping_name(*cut.mapping), mapping_name(mapping));
  }
  return {};
}

Result<Image> load_image_file(const std::string& spec, const CutOptions& cut,
                              PreparedScene& prepared) {
  auto image = read_image(spec);
  if (!image) return image;
  if (auto checked = check_against(spec, cut, *image); !checked) {
    return std::unexpected(checked.error());
  }
  auto scene = decode_scene(*image);
  if (!scene) return std::unexpected(scene.error());
  prepared.scene = std::move(*scene);
  return image;
}

}  // namespace

bool is_image_path(const std::string& spec) {
  return !spec.starts_with("builtin:") && std::filesystem::path(spec).extension() == ".grt";
}

ImageOptions image_options(const CutOptions& cut, bool with_scene) {
  ImageOptions options;
  options.bits = cut.bits.value_or(options.bits);
  options.grid = cut.grid;
  options.pes = cut.pes.value_or(options.pes);
  options.mapping = cut.mapping.value_or(options.mapping);
  options.layout = cut.layout.value_or(options.layout);
  options.with_scene = with_scene;
  return options;
}

Result<PreparedScene> prepare_scene(const std::string& spec, const CutOptions& cut,
                                    const protocol::CapabilitiesReport& capabilities) {
  PreparedScene prepared;
  const auto start = Clock::now();
  const bool is_image = is_image_path(spec);
  Image file;
  if (is_image) {
    auto loaded = load_image_file(spec, cut, prepared);
    if (!loaded) return std::unexpected(loaded.error());
    file = std::move(*loaded);
  } else {
    auto scene = load_scene(spec);
    if (!scene) return std::unexpected(scene.error());
    prepared.scene = std::move(*scene);
  }
  const auto loaded = Clock::now();
  prepared.load_seconds = seconds_between(start, loaded);
  ImageOptions options = options_for(image_options(cut, false), capabilities);
  if (!cut.pes) options.pes = std::min<int>(options.pes, capabilities.pes);
  auto images =
      is_image ? whole_image(std::move(file)) : build_scene_images(prepared.scene, options);
  if (!images) return std::unexpected(images.error());
  prepared.images = std::make_shared<const SceneImages>(std::move(*images));
  prepared.lattice = prepared.image().lattice();
  prepared.build_seconds = seconds_between(loaded, Clock::now());
  return prepared;
}

void print_warnings(std::string_view program, const Scene& scene) {
  for (const std::string& warning : scene.warnings) {
    std::fputs(fmt::format("{}: warning: {}\n", program, warning).c_str(), stderr);
  }
}

}  // namespace gridrt
