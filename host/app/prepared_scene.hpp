// A scene ready to be traced: loaded, cut and packed.
#pragma once

#include <memory>
#include <string>

#include "hal/error.hpp"
#include "host/app/options.hpp"
#include "host/grid/lattice.hpp"
#include "host/image/chunks.hpp"
#include "host/image/image.hpp"
#include "host/scene/scene.hpp"

namespace gridrt {

struct PreparedScene {
  Scene scene;
  std::shared_ptr<const SceneImages> images;
  Lattice lattice;
  double load_seconds = 0.0;
  double build_seconds = 0.0;

  [[nodiscard]] const Image& image() const { return images->front(); }
};

/// True for the path of an image file (.grt).
bool is_image_path(const std::string& spec);

/// Loads any SCENE and cuts it for a device of these capabilities, in chunks if it must be. Options
/// that contradict what a .grt was made with are refused (kUsage); other errors are those of
/// load_scene, build_image and read_image.
Result<PreparedScene> prepare_scene(const std::string& spec, const CutOptions& cut,
                                    const protocol::CapabilitiesReport& capabilities);

/// The image options that stand for `cut`.
ImageOptions image_options(const CutOptions& cut, bool with_scene);

/// Writes what a loader left out to standard error, each thing once.
void print_warnings(std::string_view program, const Scene& scene);

}  // namespace gridrt
