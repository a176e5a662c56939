// Writers of the mesh formats, independent of the readers under test.
#include <fmt/format.h>

#include "scene_support.hpp"

namespace gridrt::scene_test {

std::string to_obj(const Scene& scene) {
  std::string text = "# cube\no shape\n";
  for (const glm::vec3& p : scene.positions) {
    text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
  }
  for (const auto& [a, b, c] : scene.triangles) {
    text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
  }
  return text;
}

std::string to_ply_text(const Scene& scene) {
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment by a test\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\nproperty uchar red\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      scene.positions.size(), scene.triangles.size());
  for (const glm::vec3& p : scene.positions) {
    text += fmt::format("{:.9g} {:.9g} {:.9g} 255\n", p.x, p.y, p.z);
  }
  for (const auto& [a, b, c] : scene.triangles) {
    text += fmt::format("3 {} {} {}\n", a, b, c);
  }
  return text;
}

std::string to_ply_binary(const Scene& scene, bool big_endian) {
  std::string bytes = fmt::format(
      "ply\nformat binary_{}_endian 1.0\nelement vertex {}\nproperty double x\n"
      "property short weight\nproperty float y\nproperty double z\nelement face {}\n"
      "property list ushort uint vertex_index\nproperty list uchar float texcoord\nend_header\n",
      big_endian ? "big" : "little", scene.positions.size(), scene.triangles.size());
  for (const glm::vec3& p : scene.positions) {
    put<double>(bytes, p.x, big_endian);
    put<std::int16_t>(bytes, -7, big_endian);
    put<float>(bytes, p.y, big_endian);
    put<double>(bytes, p.z, big_endian);
  }
  for (const auto& triangle : scene.triangles) {
    put<std::uint16_t>(bytes, 3, big_endian);
    for (const std::uint32_t corner : triangle) {
      put<std::uint32_t>(bytes, corner, big_endian);
    }
    put<std::uint8_t>(bytes, 2, big_endian);
    put<float>(bytes, 0.5F, big_endian);
    put<float>(bytes, 0.25F, big_endian);
  }
  return bytes;
}

std::string to_stl_text(const Scene& scene) {
  std::string text = "solid a name of words\n";
  for (const auto& triangle : scene.triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const std::uint32_t corner : triangle) {
      const glm::vec3& p = scene.positions[corner];
      text += fmt::format("      vertex {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z);
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid a name of words\n";
}

std::string to_stl_binary(const Scene& scene) {
  std::string bytes = "solid of a binary file";
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(scene.triangles.size()));
  for (const auto& triangle : scene.triangles) {
    bytes.append(12, '\0');
    for (const std::uint32_t corner : triangle) {
      const glm::vec3& p = scene.positions[corner];
      put(bytes, p.x);
      put(bytes, p.y);
      put(bytes, p.z);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string gltf_buffer(const Scene& scene) {
  std::string bytes;
  for (const glm::vec3& p : scene.positions) {
    put(bytes, p.x);
    put(bytes, p.y);
    put(bytes, p.z);
  }
  for (const auto& triangle : scene.triangles) {
    for (const std::uint32_t corner : triangle) {
      put(bytes, corner);
    }
  }
  return bytes;
}

std::string to_gltf(const Scene& scene, const std::string& uri) {
  const std::size_t vertices = scene.positions.size();
  const std::size_t corners = 3 * scene.triangles.size();
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],)"
      R"("nodes":[{{"mesh":0}}],)"
      R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],)"
      R"("buffers":[{{"byteLength":{}{}}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},)"
      R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3"}},)"
      R"({{"bufferView":1,"componentType":5125,"count":{},"type":"SCALAR"}}]}})",
      12 * vertices + 4 * corners, uri.empty() ? "" : fmt::format(R"(,"uri":"{}")", uri),
      12 * vertices, 12 * vertices, 4 * corners, vertices, corners);
}

std::string to_glb(const std::string& json, const std::string& binary) {
  std::string text = json;
  text.resize((json.size() + 3) / 4 * 4, ' ');
  std::string data = binary;
  data.resize((binary.size() + 3) / 4 * 4, '\0');
  std::string bytes = "glTF";
  put<std::uint32_t>(bytes, 2);
  put(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + data.size()));
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  put(bytes, static_cast<std::uint32_t>(data.size()));
  return bytes + std::string("BIN\0", 4) + data;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t held = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < held ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= held ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

}  // namespace gridrt::scene_test
