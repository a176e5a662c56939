#include "host/scene/gltf_material.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace gridrt::scene_detail {
namespace {

double fraction(const std::optional<JsonNode>& node, double initial) {
  if (!node) {
    return initial;
  }
  const double value = node->number();
  if (value < 0.0 || value > 1.0) {
    node->refuse_value("is not in [0, 1]");
  }
  return value;
}

double positive(const std::optional<JsonNode>& node, double initial) {
  constexpr double kLargest = 1e30;
  const double value = node ? node->number() : initial;
  if (node && (value < 0.0 || value > kLargest)) {
    node->refuse_value("is not in [0, 1e30]");
  }
  return value;
}

// The factors of a material that matter here.
struct Factors {
  glm::dvec3 base{1.0};
  double alpha = 1.0;
  double metallic = 1.0;
  double roughness = 1.0;
  double transmission = 0.0;
  double ior = 1.5;
  glm::dvec3 emission{0.0};
  bool blended = false;
  bool unlit = false;
};

std::optional<JsonNode> extension(const JsonNode& node, const char* name) {
  return node.find("extensions", name);
}

Factors factors_of(const JsonNode& node) {
  Factors f;
  if (const auto pbr = node.find("pbrMetallicRoughness")) {
    if (const auto colour = pbr->find("baseColorFactor")) {
      const auto rgba = colour->numbers<4>();
      for (std::size_t i = 0; i < 4; ++i) {
        (i < 3 ? f.base[static_cast<int>(i)] : f.alpha) = fraction((*colour)[i], rgba[i]);
      }
    }
    f.metallic = fraction(pbr->find("metallicFactor"), 1.0);
    f.roughness = fraction(pbr->find("roughnessFactor"), 1.0);
  }
  if (const auto emissive = node.find("emissiveFactor")) {
    const auto rgb = emissive->numbers<3>();
    for (std::size_t i = 0; i < 3; ++i) {
      f.emission[static_cast<int>(i)] = fraction((*emissive)[i], rgb[i]);
    }
  }
  if (const auto strength = extension(node, "KHR_materials_emissive_strength")) {
    f.emission *= positive(strength->find("emissiveStrength"), 1.0);
  }
  if (const auto transmission = extension(node, "KHR_materials_transmission")) {
    f.transmission = fraction(transmission->find("transmissionFactor"), 0.0);
  }
  if (const auto ior = extension(node, "KHR_materials_ior")) {
    constexpr double kLargestIor = 100.0;
    // 0 stands for "all is reflected"; no refracted ray is then wanted at all.
    f.ior = std::min(positive(ior->find("ior"), 1.5), kLargestIor);
    f.transmission = f.ior > 0.0 ? f.transmission : 0.0;
    f.ior = std::max(f.ior, 0.01);
  }
  if (const auto mode = node.find("alphaMode")) {
    f.blended = mode->text() == "BLEND";
  }
  f.unlit = extension(node, "KHR_materials_unlit").has_value();
  return f;
}

glm::vec3 rounded(const glm::dvec3& colour) { return glm::vec3(colour); }

}  // namespace

Material gltf_material(const JsonNode& node) {
  constexpr double kAmbientShare = 0.1;
  constexpr double kMirrorBelow = 0.5;
  constexpr double kLargestExponent = 1e4;
  const Factors f = factors_of(node);
  Material m;
  if (const auto name = node.find("name")) {
    m.name = name->text();
  }
  if (f.unlit) {
    m.ambient = m.diffuse = glm::vec3(0.0F);
    m.emission = rounded(f.base);
    return m;
  }
  const double r = f.roughness;
  const glm::dvec3 body = f.base * (1.0 - f.metallic) * (1.0 - f.transmission);
  m.diffuse = rounded(body);
  m.ambient = rounded(glm::mix(body, f.base, f.metallic) * kAmbientShare);
  m.specular = rounded(glm::mix(glm::dvec3(0.5 * (1.0 - r)), f.base, f.metallic));
  m.shininess = static_cast<float>(
      std::clamp(2.0 / std::max(std::pow(r, 4.0), 1e-9) - 2.0, 1.0, kLargestExponent));
  if (r < kMirrorBelow) {
    m.mirror = rounded(f.base * f.metallic * (1.0 - r) * (1.0 - r));
  }
  m.transmission = rounded(f.base * f.transmission * (1.0 - f.metallic));
  m.ior = static_cast<float>(f.ior);
  m.emission = rounded(f.emission);
  if (f.blended && f.alpha < 1.0 && f.transmission == 0.0) {
    const auto alpha = static_cast<float>(f.alpha);
    m.transmission = glm::vec3(1.0F - alpha);
    m.ior = 1.0F;
    m.diffuse *= alpha;
    m.ambient *= alpha;
  }
  return m;
}

bool gltf_has_texture(const JsonNode& material) {
  return material.find("normalTexture") || material.find("occlusionTexture") ||
         material.find("emissiveTexture") ||
         material.find("pbrMetallicRoughness", "baseColorTexture") ||
         material.find("pbrMetallicRoughness", "metallicRoughnessTexture");
}

Light gltf_light(const JsonNode& node, const glm::dmat4& transform) {
  Light light;
  const std::string type = node.at("type").text();
  if (type == "directional") {
    light.kind = Light::Kind::kDirectional;
  } else if (type != "point" && type != "spot") {
    node.at("type").refuse_value("is none of directional, point and spot");
  }
  glm::dvec3 colour(1.0);
  if (const auto given = node.find("color")) {
    const auto rgb = given->numbers<3>();
    for (std::size_t i = 0; i < 3; ++i) {
      colour[static_cast<int>(i)] = fraction((*given)[i], rgb[i]);
    }
  }
  light.colour = rounded(colour * positive(node.find("intensity"), 1.0));
  light.position = glm::dvec3(transform[3]);
  light.direction = -glm::dvec3(transform[2]);  // a light shines along -z of its node
  if (light.kind == Light::Kind::kDirectional && light.direction == glm::dvec3(0.0)) {
    node.refuse_value("is a directional light in a node that flattens its direction");
  }
  return light;
}

void normalise_gltf_lights(std::vector<Light>& lights, const glm::dvec3& centre) {
  double brightest = 0.0;
  std::vector<double> at_centre;
  for (const Light& light : lights) {
    const double largest = std::max({light.colour.x, light.colour.y, light.colour.z});
    const glm::dvec3 way = light.position - centre;
    const double squared = light.kind == Light::Kind::kPoint ? glm::dot(way, way) : 1.0;
    at_centre.push_back(1.0 / std::max(squared, 1e-30));
    brightest = std::max(brightest, largest * at_centre.back());
  }
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const double factor = brightest > 0.0 ? at_centre[i] / brightest : 1.0;
    lights[i].colour = rounded(glm::dvec3(lights[i].colour) * factor);
  }
}

}  // namespace gridrt::scene_detail
