#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include "host/scene/assemble.hpp"
#include "host/scene/gltf_accessor.hpp"
#include "host/scene/gltf_document.hpp"
#include "host/scene/gltf_material.hpp"
#include "host/scene/readers.hpp"
#include "host/scene/refuse.hpp"
#include "host/scene/text.hpp"

namespace gridrt::scene_detail {
namespace {

// Extensions that change nothing that is read here, or are read.
constexpr std::array<std::string_view, 17> kKnownExtensions = {"KHR_lights_punctual",
                                                               "KHR_materials_transmission",
                                                               "KHR_materials_ior",
                                                               "KHR_materials_unlit",
                                                               "KHR_materials_emissive_strength",
                                                               "KHR_materials_volume",
                                                               "KHR_materials_specular",
                                                               "KHR_materials_clearcoat",
                                                               "KHR_materials_sheen",
                                                               "KHR_materials_iridescence",
                                                               "KHR_materials_anisotropy",
                                                               "KHR_materials_dispersion",
                                                               "KHR_materials_variants",
                                                               "KHR_texture_transform",
                                                               "KHR_texture_basisu",
                                                               "KHR_mesh_quantization",
                                                               "EXT_texture_webp"};

class GltfReader {
 public:
  GltfReader(std::string_view bytes, bool binary, const std::string& name,
             const FileResolver& resolve)
      : name_(name), document_(bytes, binary, name, resolve) {
    scene_.materials.emplace_back();
  }

  Scene read() {
    check_extensions();
    read_materials();
    meshes_.resize(document_.count("meshes"));
    visited_.resize(document_.count("nodes"));
    place_nodes();
    finish();
    return std::move(scene_);
  }

 private:
  struct Placed {
    JsonNode node;
    std::size_t index;
    glm::dmat4 parent;
  };

  void check_extensions() {
    const auto required = document_.list("extensionsRequired");
    for (std::size_t i = 0; required && i < required->size(); ++i) {
      const std::string extension = (*required)[i].text();
      if (std::find(kKnownExtensions.begin(), kKnownExtensions.end(), extension) ==
          kKnownExtensions.end()) {
        refuse(ErrorKind::kUnsupported,
               fmt::format("{}: needs the glTF extension '{}', which is not read", name_,
                           shorten(extension)),
               "export it without that extension");
      }
    }
  }

  void read_materials() {
    const auto list = document_.list("materials");
    bool textures = false;
    for (std::size_t i = 0; list && i < list->size(); ++i) {
      add_material(scene_, gltf_material((*list)[i]));
      textures = textures || gltf_has_texture((*list)[i]);
    }
    if (textures) {
      scene_.warnings.push_back(fmt::format("{}: textures are left out", name_));
    }
  }

  // Roots of the default scene, of the first one, or all nodes that are no one's child.
  std::vector<std::size_t> root_nodes() const {
    const auto scenes = document_.list("scenes");
    const auto chosen = document_.root().find("scene");
    std::vector<std::size_t> roots;
    if (chosen || (scenes && scenes->size() > 0)) {
      const JsonNode scene = chosen ? document_.element("scenes", *chosen) : (*scenes)[0];
      const auto nodes = scene.find("nodes");
      for (std::size_t i = 0; nodes && i < nodes->size(); ++i) {
        roots.push_back((*nodes)[i].index(visited_.size(), "nodes"));
      }
      return roots;
    }
    std::set<std::size_t> children;
    const auto nodes = document_.list("nodes");
    for (std::size_t i = 0; nodes && i < nodes->size(); ++i) {
      const auto list = (*nodes)[i].find("children");
      for (std::size_t k = 0; list && k < list->size(); ++k) {
        children.insert((*list)[k].index(visited_.size(), "nodes"));
      }
    }
    for (std::size_t i = 0; i < visited_.size(); ++i) {
      if (!children.contains(i)) {
        roots.push_back(i);
      }
    }
    return roots;
  }

  // Depth first, children in their order, without recursion: files may nest deeply.
  void place_nodes() {
    std::vector<Placed> stack;
    const auto push_reversed = [&](const std::vector<std::size_t>& nodes,
                                   const glm::dmat4& parent) {
      for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) {
        stack.push_back({document_.root().at("nodes")[*i], *i, parent});
      }
    };
    push_reversed(root_nodes(), glm::dmat4(1.0));
    while (!stack.empty()) {
      const Placed placed = std::move(stack.back());
      stack.pop_back();
      if (visited_[placed.index]) {
        placed.node.refuse_value("is reached twice: nodes must form trees");
      }
      visited_[placed.index] = true;
      const glm::dmat4 transform = placed.parent * local_transform(placed.node);
      place_node(placed.node, transform);
      std::vector<std::size_t> children;
      const auto list = placed.node.find("children");
      for (std::size_t i = 0; list && i < list->size(); ++i) {
        children.push_back((*list)[i].index(visited_.size(), "nodes"));
      }
      push_reversed(children, transform);
    }
  }

  static glm::dmat4 local_transform(const JsonNode& node) {
    glm::dmat4 transform(1.0);
    if (const auto matrix = node.find("matrix")) {
      const auto values = matrix->numbers<16>();
      for (std::size_t i = 0; i < 16; ++i) {
        transform[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = values[i];
      }
      if (values[3] != 0.0 || values[7] != 0.0 || values[11] != 0.0 || values[15] != 1.0) {
        matrix->refuse_value("is not affine");
      }
      return transform;
    }
    if (const auto rotation = node.find("rotation")) {
      const auto [x, y, z, w] = rotation->numbers<4>();
      const glm::dquat quaternion(w, x, y, z);
      const double length = glm::length(quaternion);
      if (!(length > 0.0) || !std::isfinite(length)) {
        rotation->refuse_value("is no rotation");
      }
      transform = glm::mat4_cast(quaternion / length);
    }
    if (const auto scale = node.find("scale")) {
      const auto values = scale->numbers<3>();
      for (int i = 0; i < 3; ++i) {
        transform[i] *= values[static_cast<std::size_t>(i)];
      }
    }
    if (const auto translation = node.find("translation")) {
      const auto [x, y, z] = translation->numbers<3>();
      transform[3] = glm::dvec4(x, y, z, 1.0);
    }
    return transform;
  }

  void place_node(const JsonNode& node, const glm::dmat4& transform) {
    if (const auto mesh = node.find("mesh")) {
      const std::size_t index = mesh->index(meshes_.size(), "meshes");
      std::optional<Scene>& part = meshes_[index];
      if (!part) part = read_mesh(document_.root().at("meshes")[index]);
      skinned_ = skinned_ || node.find("skin").has_value();
      Placement placement;
      placement.matrix = transform;
      require(append_scene(scene_, *part, placement, fmt::format("{}: {}", name_, node.path())));
    }
    if (const auto camera = node.find("camera")) {
      place_camera(document_.element("cameras", *camera), transform);
    }
    const auto extensions = node.find("extensions");
    if (const auto light =
            extensions ? extensions->find("KHR_lights_punctual", "light") : std::nullopt) {
      place_light(*light, transform);
    }
  }

  void place_light(const JsonNode& reference, const glm::dmat4& transform) {
    const auto extensions = document_.root().find("extensions");
    const auto lights =
        extensions ? extensions->find("KHR_lights_punctual", "lights") : std::nullopt;
    const std::size_t index = reference.index(lights ? lights->size() : 0, "lights");
    if (lights) scene_.lights.push_back(gltf_light((*lights)[index], transform));
  }

  // The first perspective camera is the scene's.
  void place_camera(const JsonNode& camera, const glm::dmat4& transform) {
    const auto perspective = camera.find("perspective");
    if (!perspective || scene_.camera) {
      scene_.warnings.push_back(fmt::format("{}: {} is left out", name_, camera.path()));
      return;
    }
    const double fov = perspective->at("yfov").number();
    const glm::dvec3 forward = -glm::dvec3(transform[2]);
    const bool has_view = fov > 0.0 && fov < std::numbers::pi && glm::length(forward) > 0.0;
    if (!has_view) {
      perspective->refuse_value("has no view: yfov is not in (0, pi), or its node is flat");
    }
    Camera result;
    result.eye = glm::dvec3(transform[3]);
    result.look = result.eye + glm::normalize(forward);
    result.up = glm::dvec3(transform[1]);
    result.fov_degrees = fov * 180.0 / std::numbers::pi;
    scene_.camera = result;
  }

  Scene read_mesh(const JsonNode& mesh) {
    Scene part;
    const JsonNode primitives = mesh.at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      read_primitive(part, primitives[i]);
    }
    return part;
  }

  void read_primitive(Scene& part, const JsonNode& primitive) {
    constexpr std::uint64_t kTriangles = 4;
    constexpr std::uint64_t kFan = 6;
    const auto mode_node = primitive.find("mode");
    const std::uint64_t mode = mode_node ? mode_node->whole(kFan + 1) : kTriangles;
    if (mode < kTriangles) {
      not_drawn_ = true;
      return;
    }
    morphed_ = morphed_ || primitive.find("targets").has_value();
    const JsonNode attributes = primitive.at("attributes");
    const GltfAccessor positions(document_, attributes.at("POSITION"), "VEC3");
    const auto first = static_cast<std::uint32_t>(part.positions.size());
    if (positions.count() >= kNoIndex - first) {
      refuse(ErrorKind::kLimit, fmt::format("{}: too many vertices", name_));
    }
    for (std::size_t i = 0; i < positions.count(); ++i) {
      add_vertex(part, positions.vector(i));
    }
    const std::vector<std::uint32_t> normals = read_normals(part, attributes, positions.count());
    const std::vector<std::uint32_t> corners = read_corners(primitive, positions.count());
    const auto material_node = primitive.find("material");
    const std::size_t material =
        material_node ? material_node->index(scene_.materials.size() - 1, "materials") + 1 : 0;
    const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
      const Corners v{corners[a], corners[b], corners[c]};
      add_triangle(part, {first + v[0], first + v[1], first + v[2]},
                   static_cast<std::uint32_t>(material),
                   normals.empty() ? kFlat : Corners{normals[v[0]], normals[v[1]], normals[v[2]]});
    };
    if (mode == kTriangles && corners.size() % 3 != 0) {
      primitive.refuse_value(fmt::format("has {} corners, not whole triangles", corners.size()));
    }
    if (mode == kTriangles) {
      for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        triangle(i, i + 1, i + 2);
      }
      return;
    }
    // The orders of the glTF specification, section 3.7.2.1.
    for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
      if (mode == kFan) {
        triangle(i + 1, i + 2, 0);
      } else {
        triangle(i, i + 1 + i % 2, i + 2 - i % 2);
      }
    }
  }

  // One index into part.normals a vertex, or nothing where there are no normals.
  std::vector<std::uint32_t> read_normals(Scene& part, const JsonNode& attributes,
                                          std::size_t count) {
    std::vector<std::uint32_t> normals;
    const auto reference = attributes.find("NORMAL");
    if (!reference) {
      return normals;
    }
    const GltfAccessor accessor(document_, *reference, "VEC3");
    if (accessor.count() != count) {
      accessor.refuse_value(fmt::format("has {} normals for {} vertices", accessor.count(), count));
    }
    for (std::size_t i = 0; i < count; ++i) {
      normals.push_back(add_normal(part, accessor.vector(i)));
    }
    return normals;
  }

  std::vector<std::uint32_t> read_corners(const JsonNode& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> corners;
    const auto reference = primitive.find("indices");
    if (!reference) {
      corners.resize(vertices);
      for (std::size_t i = 0; i < vertices; ++i) {
        corners[i] = static_cast<std::uint32_t>(i);
      }
      return corners;
    }
    const GltfAccessor accessor(document_, *reference, "SCALAR");
    if (!accessor.is_index_type()) {
      accessor.refuse_value("holds indices, but not as unsigned integers");
    }
    corners.reserve(accessor.count());
    for (std::size_t i = 0; i < accessor.count(); ++i) {
      corners.push_back(accessor.index(i));
      if (corners.back() >= vertices) {
        accessor.refuse_value(
            fmt::format("element {} is {}, beyond the {} vertices", i, corners.back(), vertices));
      }
    }
    return corners;
  }

  void finish() {
    if (not_drawn_) {
      scene_.warnings.push_back(fmt::format("{}: points and lines are left out", name_));
    }
    if (skinned_ || morphed_) {
      scene_.warnings.push_back(
          fmt::format("{}: skins and morph targets are left out: shapes at rest", name_));
    }
    if (scene_.triangles.empty()) {
      scene_.warnings.push_back(fmt::format("{}: no triangles", name_));
    }
    glm::dvec3 low(std::numeric_limits<double>::infinity());
    glm::dvec3 high = -low;
    for (const glm::vec3& p : scene_.positions) {
      low = glm::min(low, glm::dvec3(p));
      high = glm::max(high, glm::dvec3(p));
    }
    const glm::dvec3 centre = scene_.positions.empty() ? glm::dvec3(0.0) : (low + high) * 0.5;
    normalise_gltf_lights(scene_.lights, centre);
  }

  const std::string& name_;
  GltfDocument document_;
  Scene scene_;
  std::vector<std::optional<Scene>> meshes_;
  std::vector<bool> visited_;
  bool not_drawn_ = false;
  bool skinned_ = false;
  bool morphed_ = false;
};

}  // namespace

Result<Scene> read_gltf(std::string_view bytes, bool binary, const std::string& name,
                        const FileResolver& resolve) {
  try {
    return GltfReader(bytes, binary, name, resolve).read();
  } catch (const Refusal& refusal) {
    return std::unexpected(refusal.error());
  }
}

}  // namespace gridrt::scene_detail
