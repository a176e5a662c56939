// What a built-in scene is: a name, its options with their ranges, and a function that makes it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "hal/error.hpp"
#include "host/scene/scene.hpp"

namespace gridrt::scene_detail {

/// How the text of an option is read.
enum class OptionKind { kInteger, kReal, kVector, kChoice };

/// One option of a built-in scene.
struct BuiltinOption {
  const char* name;
  OptionKind kind;
  const char* initial;  ///< default, as text
  double lowest;        ///< of integers, reals and each part of a vector
  double highest;
  const char* help;  ///< for kChoice: begins with the choices, "a|b: ..."
};

/// The options of one call, read and within their ranges.
class BuiltinValues {
 public:
  double real(std::string_view name) const { return numbers_.find(name)->second.x; }
  std::uint32_t integer(std::string_view name) const {
    return static_cast<std::uint32_t>(real(name));
  }
  glm::dvec3 vector(std::string_view name) const { return numbers_.find(name)->second; }
  const std::string& choice(std::string_view name) const { return texts_.find(name)->second; }

  void set(const std::string& name, const glm::dvec3& number) { numbers_[name] = number; }
  void set(const std::string& name, const std::string& text) { texts_[name] = text; }

 private:
  std::map<std::string, glm::dvec3, std::less<>> numbers_;
  std::map<std::string, std::string, std::less<>> texts_;
};

/// One built-in scene. `make` gets every option's value and cannot fail; materials may be left
/// empty (the default one is added).
struct Builtin {
  const char* name;
  const char* summary;
  std::vector<BuiltinOption> options;
  Result<Scene> (*make)(const BuiltinValues& values);
};

/// The groups of built-in scenes, one a source file.
std::vector<Builtin> shape_builtins();
std::vector<Builtin> teapot_builtins();
std::vector<Builtin> whitted_builtins();
std::vector<Builtin> room_builtins();
std::vector<Builtin> hard_builtins();

/// Sebastiano Vigna's splitmix64: 64 random bits a call, the same on every machine.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits();
  /// Uniform in [low, high), a multiple of (high - low) 2^-53 above low.
  double uniform(double low, double high);

 private:
  std::uint64_t state_;
};

/// Adds a box of 12 triangles, outsides outward; `inward` turns them inward.
void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, std::uint32_t material,
             bool inward = false);

/// Adds a quad of two triangles over the corners a, b, c, d in order.
void add_quad(Scene& scene, const std::array<glm::dvec3, 4>& corners, std::uint32_t material);

/// Adds a geodesic sphere of 20 * 4^subdivisions triangles, welded, with smooth normals if asked.
void add_icosphere(Scene& scene, const glm::dvec3& centre, double radius,
                   std::uint32_t subdivisions, std::uint32_t material, bool smooth);

/// Adds a box like add_box() whose sides are cut into `cells` x `cells` quads each.
void add_fine_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, std::uint32_t cells,
                  std::uint32_t material, bool inward);

/// Newell's teapot, y up, standing on y = 0, spout along +x, 3.15 high: each of its 32 patches is
/// cut into `tessellation` x `tessellation` quads; vertices shared by patches are one; smooth.
/// Triangles that are points or segments at the poles of lid and bottom are left out.
Scene make_teapot(std::uint32_t tessellation);

}  // namespace gridrt::scene_detail
