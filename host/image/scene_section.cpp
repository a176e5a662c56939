#include "host/image/scene_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "host/image/byte_stream.hpp"

namespace gridrt {
namespace {

constexpr std::size_t kMaterialBytes = 4 + 20 * 4;  // of a material without a name
constexpr std::size_t kLightBytes = 1 + 6 * 8 + 3 * 4;

using Triple = std::array<std::uint32_t, 3>;

void put(ByteWriter& out, const glm::vec3& v) {
  for (int a = 0; a < 3; ++a) out.f32(v[a]);
}

void put(ByteWriter& out, const glm::dvec3& v) {
  for (int a = 0; a < 3; ++a) out.f64(v[a]);
}

void put(ByteWriter& out, const Triple& t) {
  for (const std::uint32_t i : t) out.u32(i);
}

void put(ByteWriter& out, const Material& m) {
  out.text(m.name);
  for (const glm::vec3* v : {&m.ambient, &m.diffuse, &m.specular}) put(out, *v);
  out.f32(m.shininess);
  for (const glm::vec3* v : {&m.mirror, &m.transmission}) put(out, *v);
  out.f32(m.ior);
  put(out, m.emission);
}

void put(ByteWriter& out, const Light& l) {
  out.u8(l.kind == Light::Kind::kPoint ? 0 : 1);
  put(out, l.position);
  put(out, l.direction);
  put(out, l.colour);
}

void get(ByteReader& in, glm::vec3& v) {
  for (int a = 0; a < 3; ++a) v[a] = in.f32();
}

void get(ByteReader& in, glm::dvec3& v) {
  for (int a = 0; a < 3; ++a) v[a] = in.f64();
}

void get(ByteReader& in, Triple& t) {
  for (std::uint32_t& i : t) i = in.u32();
}

void get(ByteReader& in, std::uint32_t& value) { value = in.u32(); }

void get(ByteReader& in, Material& m) {
  m.name = in.text();
  for (glm::vec3* v : {&m.ambient, &m.diffuse, &m.specular}) get(in, *v);
  m.shininess = in.f32();
  for (glm::vec3* v : {&m.mirror, &m.transmission}) get(in, *v);
  m.ior = in.f32();
  get(in, m.emission);
}

/// The kind's byte is checked by the caller.
std::uint8_t get(ByteReader& in, Light& l) {
  const std::uint8_t kind = in.u8();
  l.kind = kind == 0 ? Light::Kind::kPoint : Light::Kind::kDirectional;
  get(in, l.position);
  get(in, l.direction);
  get(in, l.colour);
  return kind;
}

/// Reads `count` items of `size` bytes each; nothing if there are not as many.
template <class T>
void get_all(ByteReader& in, std::vector<T>& items, std::uint32_t count, std::size_t size) {
  if (!in.has(count, size)) return;
  items.resize(count);
  for (T& item : items) get(in, item);
}

template <class V>
bool finite(const V& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

Result<void> bad(std::string message) {
  return fail(ErrorKind::kInput, "scene section: " + std::move(message));
}

Result<void> check_geometry(const Scene& s) {
  for (std::size_t i = 0; i < s.positions.size(); ++i) {
    if (!finite(s.positions[i])) return bad(fmt::format("vertex {} is not finite", i));
  }
  for (std::size_t i = 0; i < s.normals.size(); ++i) {
    if (!finite(s.normals[i])) return bad(fmt::format("normal {} is not finite", i));
  }
  if (s.triangle_materials.size() != s.triangles.size()) {
    return bad(fmt::format("{} triangles, but {} have a material", s.triangles.size(),
                           s.triangle_materials.size()));
  }
  if (!s.triangle_normals.empty() && s.triangle_normals.size() != s.triangles.size()) {
    return bad(fmt::format("{} triangles, but {} have normals", s.triangles.size(),
                           s.triangle_normals.size()));
  }
  for (std::size_t i = 0; i < s.triangles.size(); ++i) {
    for (const std::uint32_t v : s.triangles[i]) {
      if (v >= s.positions.size()) {
        return bad(fmt::format("triangle {}: vertex {} of {}", i, v, s.positions.size()));
      }
    }
    if (s.triangle_materials[i] >= s.materials.size()) {
      return bad(fmt::format("triangle {}: material {} of {}", i, s.triangle_materials[i],
                             s.materials.size()));
    }
  }
  for (std::size_t i = 0; i < s.triangle_normals.size(); ++i) {
    const Triple& n = s.triangle_normals[i];
    const bool flat = n == Triple{kNoIndex, kNoIndex, kNoIndex};
    if (!flat && std::ranges::any_of(n, [&](auto k) { return k >= s.normals.size(); })) {
      return bad(fmt::format("triangle {}: normals {}, {}, {} of {}", i, n[0], n[1], n[2],
                             s.normals.size()));
    }
  }
  return {};
}

Result<void> check_shading(const Scene& s) {
  if (s.materials.empty()) return bad("no material");
  for (std::size_t i = 0; i < s.materials.size(); ++i) {
    const Material& m = s.materials[i];
    for (const glm::vec3* v :
         {&m.ambient, &m.diffuse, &m.specular, &m.mirror, &m.transmission, &m.emission}) {
      if (!finite(*v)) return bad(fmt::format("material {}: a colour is not finite", i));
    }
    if (!std::isfinite(m.shininess) || m.shininess < 0.0F) {
      return bad(fmt::format("material {}: shininess {}", i, m.shininess));
    }
    if (!std::isfinite(m.ior) || m.ior <= 0.0F) {
      return bad(fmt::format("material {}: index of refraction {}", i, m.ior));
    }
  }
  for (std::size_t i = 0; i < s.lights.size(); ++i) {
    const Light& l = s.lights[i];
    if (!finite(l.position) || !finite(l.direction) || !finite(l.colour)) {
      return bad(fmt::format("light {}: a number is not finite", i));
    }
  }
  if (s.camera) {
    const Camera& c = *s.camera;
    if (!finite(c.eye) || !finite(c.look) || !finite(c.up)) {
      return bad("camera: a number is not finite");
    }
    const bool valid = c.fov_degrees > 0.0 && c.fov_degrees < 180.0;
    if (!valid) {
      return bad(fmt::format("camera: field of view {}", c.fov_degrees));
    }
  }
  if (!finite(s.background) || !finite(s.ambient_light)) {
    return bad("background or ambient light is not finite");
  }
  return {};
}

Result<void> check_scene(const Scene& s) {
  Result<void> good = check_shading(s);
  return good ? check_geometry(s) : good;
}

}  // namespace

Result<std::vector<std::byte>> pack_scene(const Scene& scene) {
  for (const std::size_t count :
       {scene.positions.size(), scene.triangles.size(), scene.normals.size(),
        scene.materials.size(), scene.lights.size()}) {
    if (count > std::numeric_limits<std::uint32_t>::max()) {
      return fail(ErrorKind::kLimit, fmt::format("scene section: {} items of a kind", count),
                  "split the scene");
    }
  }
  if (auto good = check_scene(scene); !good) return std::unexpected(std::move(good.error()));
  ByteWriter out;
  out.u32(kSceneVersion);
  for (const std::size_t count :
       {scene.positions.size(), scene.triangles.size(), scene.normals.size(),
        scene.triangle_normals.size(), scene.materials.size(), scene.lights.size()}) {
    out.u32(static_cast<std::uint32_t>(count));
  }
  out.u8(scene.camera ? 1 : 0);
  put(out, scene.background);
  put(out, scene.ambient_light);
  if (scene.camera) {
    for (const glm::dvec3* v : {&scene.camera->eye, &scene.camera->look, &scene.camera->up}) {
      put(out, *v);
    }
    out.f64(scene.camera->fov_degrees);
  }
  for (const Material& m : scene.materials) put(out, m);
  for (const Light& l : scene.lights) put(out, l);
  for (const glm::vec3& v : scene.positions) put(out, v);
  for (const Triple& t : scene.triangles) put(out, t);
  for (const std::uint32_t m : scene.triangle_materials) out.u32(m);
  for (const glm::vec3& n : scene.normals) put(out, n);
  for (const Triple& n : scene.triangle_normals) put(out, n);
  return out.take();
}

Result<Scene> unpack_scene(std::span<const std::byte> bytes) {
  ByteReader in(bytes);
  const std::uint32_t version = in.u32();
  if (in.good() && version != kSceneVersion) {
    return fail(ErrorKind::kInput,
                fmt::format("scene section: version {}, not {}", version, kSceneVersion),
                "write the file again with this version of gridrt-image");
  }
  Scene scene;
  const std::uint32_t positions = in.u32();
  const std::uint32_t triangles = in.u32();
  const std::uint32_t normals = in.u32();
  const std::uint32_t smooth = in.u32();
  const std::uint32_t materials = in.u32();
  const std::uint32_t lights = in.u32();
  const std::uint8_t camera = in.u8();
  std::uint8_t largest_kind = 0;
  get(in, scene.background);
  get(in, scene.ambient_light);
  if (camera != 0) {
    Camera& c = scene.camera.emplace();
    for (glm::dvec3* v : {&c.eye, &c.look, &c.up}) get(in, *v);
    c.fov_degrees = in.f64();
  }
  get_all(in, scene.materials, materials, kMaterialBytes);
  if (in.has(lights, kLightBytes)) {
    scene.lights.resize(lights);
    for (Light& l : scene.lights) largest_kind = std::max(largest_kind, get(in, l));
  }
  get_all(in, scene.positions, positions, 12);
  get_all(in, scene.triangles, triangles, 12);
  get_all(in, scene.triangle_materials, triangles, 4);
  get_all(in, scene.normals, normals, 12);
  get_all(in, scene.triangle_normals, smooth, 12);
  Result<void> good;
  if (!in.good()) {
    good = bad(fmt::format("it ends too early, at byte {}", bytes.size()));
  } else if (in.left() != 0) {
    good = bad(fmt::format("{} bytes too many, from byte {}", in.left(), in.offset()));
  } else if (camera > 1) {
    good = bad(fmt::format("camera flag {}", camera));
  } else if (largest_kind > 1) {
    good = bad(fmt::format("a light of kind {}", largest_kind));
  } else {
    good = check_scene(scene);
  }
  if (!good) return std::unexpected(std::move(good.error()));
  return scene;
}

}  // namespace gridrt
