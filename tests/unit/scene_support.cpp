#include "scene_support.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace gridrt::scene_test {

Result<Scene> load(SceneFormat format, std::string_view bytes, const Files& files) {
  return load_scene_from_memory(format, bytes, "mesh",
                                [&](const std::string& name) -> Result<std::string> {
                                  const auto file = files.find(name);
                                  if (file == files.end()) {
                                    return fail(ErrorKind::kFile, name + ": not there");
                                  }
                                  return file->second;
                                });
}

Scene good(SceneFormat format, std::string_view bytes, const Files& files) {
  auto scene = load(format, bytes, files);
  EXPECT_TRUE(scene.has_value()) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

void expect_refused(SceneFormat format, std::string_view bytes,
                    const std::vector<std::string>& parts, const Files& files) {
  const auto scene = load(format, bytes, files);
  ASSERT_FALSE(scene.has_value()) << "accepted: " << bytes.substr(0, 200);
  EXPECT_EQ(scene.error().kind, ErrorKind::kInput) << scene.error().message;
  for (const std::string& part : parts) {
    EXPECT_NE(scene.error().message.find(part), std::string::npos)
        << "'" << part << "' is not in: " << scene.error().message;
  }
}

Scene builtin(const std::string& spec) {
  auto scene = load_scene("builtin:" + spec);
  EXPECT_TRUE(scene.has_value()) << scene.error().message;
  return scene ? std::move(*scene) : Scene{};
}

std::vector<float> corners_of(const Scene& scene) {
  std::vector<float> numbers;
  for (const auto& triangle : scene.triangles) {
    for (const std::uint32_t corner : triangle) {
      const glm::vec3& p = scene.positions[corner];
      numbers.insert(numbers.end(), {p.x, p.y, p.z});
    }
  }
  return numbers;
}

double volume_of(const Scene& scene) {
  double volume = 0.0;
  for (const auto& [a, b, c] : scene.triangles) {
    volume += glm::dot(glm::dvec3(scene.positions[a]),
                       glm::cross(glm::dvec3(scene.positions[b]), glm::dvec3(scene.positions[c])));
  }
  return volume / 6.0;
}

bool is_closed(const Scene& scene) {
  using Point = std::array<float, 3>;
  std::multiset<std::pair<Point, Point>> edges;
  const auto point = [&](std::uint32_t i) {
    const glm::vec3& p = scene.positions[i];
    return Point{p.x, p.y, p.z};
  };
  for (const auto& triangle : scene.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.emplace(point(triangle[k]), point(triangle[(k + 1) % 3]));
    }
  }
  return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
    return edges.count(edge) == edges.count({edge.second, edge.first});
  });
}

bool warns(const Scene& scene, std::string_view part) {
  return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                     [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

}  // namespace gridrt::scene_test
