// Scenes in TOML: placed and instanced meshes, materials, lights, a camera.
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "host/scene/assemble.hpp"
#include "host/scene/readers.hpp"
#include "host/scene/refuse.hpp"
#include "host/scene/text.hpp"
#include "host/scene/toml_library.hpp"
#include "host/scene/toml_value.hpp"

namespace gridrt::scene_detail {
namespace {

constexpr double kHighestLight = 1e6;
constexpr double kHighestExponent = 1e6;

// What the file of a mesh gave, and where its own materials stand in the scene.
struct LoadedMesh {
  Scene scene;
  std::optional<std::uint32_t> first_material;
};

class TomlReader {
 public:
  TomlReader(std::string_view text, const std::string& name, const FileResolver& resolve)
      : name_(name), resolve_(resolve) {
    try {
      document_ = toml::parse(text, name);
    } catch (const toml::parse_error& error) {
      refuse(ErrorKind::kInput,
             fmt::format("{}:{}: {}", name, error.source().begin.line, error.description()));
    }
    scene_.materials.emplace_back();
  }

  Scene read() {
    const TomlValue root(document_, "the scene", name_);
    root.allow_keys({"background", "ambient", "camera", "light", "material", "mesh"});
    if (const auto background = root.find("background")) {
      scene_.background = background->colour(kHighestLight);
    }
    if (const auto ambient = root.find("ambient")) {
      scene_.ambient_light = ambient->colour(kHighestLight);
    }
    if (const auto camera = root.find("camera")) {
      read_camera(*camera);
    }
    for (const TomlValue& light : tables(root, "light")) {
      read_light(light);
    }
    for (const TomlValue& material : tables(root, "material")) {
      read_material(material);
    }
    for (const TomlValue& mesh : tables(root, "mesh")) {
      read_mesh(mesh);
    }
    if (scene_.triangles.empty()) {
      scene_.warnings.push_back(fmt::format("{}: no triangles", name_));
    }
    if (scene_.lights.empty()) {
      scene_.warnings.push_back(fmt::format("{}: no [[light]]: ambient light only", name_));
    }
    return std::move(scene_);
  }

 private:
  static std::vector<TomlValue> tables(const TomlValue& root, const char* key) {
    const auto found = root.find(key);
    if (found && !found->is_array()) {
      found->refuse_value("is not a list of tables", fmt::format("write [[{}]]", key));
    }
    return found ? found->elements() : std::vector<TomlValue>{};
  }

  void read_camera(const TomlValue& table) {
    table.allow_keys({"eye", "look", "up", "fov"});
    Camera camera;
    camera.eye = table.at("eye").vector();
    camera.look = table.at("look").vector();
    if (const auto up = table.find("up")) {
      camera.up = up->vector();
      if (camera.up == glm::dvec3(0.0)) {
        up->refuse_value("is zero");
      }
    }
    if (const auto fov = table.find("fov")) {
      camera.fov_degrees = fov->number();
      if (!is_field_of_view(camera.fov_degrees)) {
        fov->refuse_value(
            fmt::format("is {}, but must be between 0 and 180 degrees", camera.fov_degrees));
      }
    }
    if (camera.eye == camera.look) {
      table.refuse_value("has its eye where it looks");
    }
    scene_.camera = camera;
  }

  void read_light(const TomlValue& table) {
    table.allow_keys({"type", "position", "direction", "colour", "intensity"});
    Light light;
    const std::string type = table.at("type").text();
    if (type == "point") {
      light.position = table.at("position").vector();
    } else if (type == "directional") {
      light.kind = Light::Kind::kDirectional;
      light.direction = table.at("direction").vector();
      if (light.direction == glm::dvec3(0.0)) {
        table.at("direction").refuse_value("is zero");
      }
    } else {
      table.at("type").refuse_value(fmt::format("is '{}'", shorten(type)),
                                    "give point or directional");
    }
    if (table.find(type == "point" ? "direction" : "position")) {
      table.refuse_value(
          fmt::format("of type {} has a {}", type, type == "point" ? "direction" : "position"));
    }
    if (const auto colour = table.find("colour")) {
      light.colour = colour->colour(kHighestLight);
    }
    if (const auto intensity = table.find("intensity")) {
      light.colour *= static_cast<float>(intensity->number_in(0.0, kHighestLight));
    }
    scene_.lights.push_back(light);
  }

  void read_material(const TomlValue& table) {
    table.allow_keys({"name", "ambient", "diffuse", "specular", "shininess", "mirror",
                      "transmission", "ior", "emission"});
    Material material;
    material.name = table.at("name").text();
    const auto colour = [&](const char* key, glm::vec3& value, double highest) {
      if (const auto found = table.find(key)) {
        value = found->colour(highest);
      }
    };
    colour("diffuse", material.diffuse, 1.0);
    constexpr float kAmbientShare = 0.1F;
    material.ambient = material.diffuse * kAmbientShare;
    colour("ambient", material.ambient, 1.0);
    colour("specular", material.specular, 1.0);
    colour("mirror", material.mirror, 1.0);
    colour("transmission", material.transmission, 1.0);
    colour("emission", material.emission, kHighestLight);
    if (const auto shininess = table.find("shininess")) {
      material.shininess = static_cast<float>(shininess->number_in(0.0, kHighestExponent));
    }
    if (const auto ior = table.find("ior")) {
      material.ior = static_cast<float>(ior->number_in(0.01, 100.0));
    }
    const auto index = static_cast<std::uint32_t>(scene_.materials.size());
    if (!materials_.emplace(material.name, index).second) {
      table.at("name").refuse_value(
          fmt::format("'{}' is that of an earlier material", shorten(material.name)));
    }
    add_material(scene_, std::move(material));
  }

  // The transform that a [[mesh]] or one of its instances gives: a matrix, or scale, then rotate,
  // then translate.
  static glm::dmat4 transform_of(const TomlValue& table) {
    const auto translate = table.find("translate");
    const auto rotate = table.find("rotate");
    const auto scale = table.find("scale");
    if (const auto matrix = table.find("matrix")) {
      if (translate || rotate || scale) {
        matrix->refuse_value("stands beside translate, rotate or scale", "give one or the other");
      }
      return matrix->matrix();
    }
    glm::dmat4 transform(1.0);
    if (translate) {
      transform = glm::translate(transform, translate->vector());
    }
    if (rotate) {
      transform = transform * rotation_of(*rotate);
    }
    if (scale) {
      transform =
          glm::scale(transform, scale->is_array() ? scale->vector() : glm::dvec3(scale->number()));
    }
    return transform;
  }

  static glm::dmat4 rotation_of(const TomlValue& value) {
    const std::vector<TomlValue> parts = value.elements();
    if (parts.size() != 4) {
      value.refuse_value("is not an array of four numbers", "give the axis x, y, z and degrees");
    }
    const glm::dvec3 axis(parts[0].number(), parts[1].number(), parts[2].number());
    const double largest = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
    if (largest == 0.0) {
      value.refuse_value("has no axis");
    }
    return glm::rotate(glm::dmat4(1.0), glm::radians(parts[3].number()), axis / largest);
  }

  void read_mesh(const TomlValue& table) {
    table.allow_keys(
        {"file", "translate", "rotate", "scale", "matrix", "instances", "material", "smooth"});
    const TomlValue file = table.at("file");
    LoadedMesh& mesh = load(file, table.find("smooth"));
    Placement placement;
    if (const auto material = table.find("material")) {
      const auto found = materials_.find(material->text());
      if (found == materials_.end()) {
        material->refuse_value(
            fmt::format("names no [[material]]: '{}'", shorten(material->text())));
      }
      placement.material = found->second;
    } else {
      placement.first_material = own_materials(mesh);
    }
    const glm::dmat4 transform = transform_of(table);
    const auto instances = table.find("instances");
    if (!instances) {
      placement.matrix = transform;
      require(append_scene(scene_, mesh.scene, placement, file.place()));
      return;
    }
    for (const TomlValue& instance : instances->elements()) {
      instance.allow_keys({"translate", "rotate", "scale", "matrix"});
      placement.matrix = transform_of(instance) * transform;
      require(append_scene(scene_, mesh.scene, placement, instance.place()));
    }
  }

  // Adds the materials of a mesh's file when they are first needed.
  std::uint32_t own_materials(LoadedMesh& mesh) {
    if (!mesh.first_material) {
      mesh.first_material = static_cast<std::uint32_t>(scene_.materials.size());
      for (const Material& material : mesh.scene.materials) {
        add_material(scene_, material);
      }
    }
    return *mesh.first_material;
  }

  // Loads a mesh once for each way of shading.
  LoadedMesh& load(const TomlValue& file, const std::optional<TomlValue>& smooth) {
    const std::string path = file.text();
    const int shading = smooth ? (smooth->boolean() ? 1 : 2) : 0;
    const auto [entry, added] = meshes_.try_emplace({path, shading});
    if (!added) {
      return entry->second;
    }
    LoadedMesh& mesh = entry->second;
    mesh.scene = load_file(file, path);
    if (shading == 1) {
      make_smooth(mesh.scene);
    } else if (shading == 2) {
      make_flat(mesh.scene);
    }
    scene_.warnings.insert(scene_.warnings.end(), mesh.scene.warnings.begin(),
                           mesh.scene.warnings.end());
    return mesh;
  }

  Scene load_file(const TomlValue& file, const std::string& path) {
    constexpr std::string_view kBuiltin = "builtin:";
    if (path.starts_with(kBuiltin)) {
      return accept(file, make_builtin(std::string_view(path).substr(kBuiltin.size())));
    }
    const auto format = format_of(path);
    if (!format) {
      file.refuse_value(fmt::format("is '{}', not a known kind of mesh", shorten(path)),
                        "give an .obj, .ply, .stl, .gltf or .glb file, or builtin:NAME");
    }
    if (*format == SceneFormat::kToml) {
      file.refuse_value(fmt::format("is '{}', a scene within a scene", shorten(path)),
                        "place its meshes here instead");
    }
    const std::string bytes = accept(file, resolve_(path));
    const std::size_t slash = path.find_last_of('/');
    const std::string folder = slash == std::string::npos ? "" : path.substr(0, slash + 1);
    return accept(file, load_scene_from_memory(*format, bytes, path, [&](const std::string& side) {
                    return resolve_(side.starts_with('/') ? side : folder + side);
                  }));
  }

  // The value of a result, or its error with the place in this file in front.
  template <class T>
  static T accept(const TomlValue& file, Result<T> result) {
    if (!result) {
      Error error = std::move(result.error());
      error.message = fmt::format("{}: {}", file.place(), error.message);
      throw Refusal(std::move(error));
    }
    return std::move(*result);
  }

  const std::string& name_;
  const FileResolver& resolve_;
  toml::table document_;
  Scene scene_;
  std::map<std::string, std::uint32_t, std::less<>> materials_;
  std::map<std::pair<std::string, int>, LoadedMesh> meshes_;
};

}  // namespace

Result<Scene> read_toml(std::string_view text, const std::string& name,
                        const FileResolver& resolve) {
  try {
    return TomlReader(text, name, resolve).read();
  } catch (const Refusal& refusal) {
    return std::unexpected(refusal.error());
  }
}

}  // namespace gridrt::scene_detail
