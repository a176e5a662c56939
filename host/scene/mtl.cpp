#include "host/scene/mtl.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "host/scene/assemble.hpp"
#include "host/scene/number.hpp"
#include "host/scene/text.hpp"

namespace gridrt::scene_detail {
namespace {

constexpr float kAmbientShare = 0.1F;
constexpr int kLastModel = 10;

// What is known of other programs' statements and has no counterpart here (the parameters of
// physically based models among them).
constexpr auto kNoEffect = std::to_array<std::string_view>(
    {"sharpness", "Pr", "Pm", "Ps", "Pc", "Pcr", "aniso", "anisor", "Km", "fl"});

// The statements of one material, before its illumination model says what they mean.
struct Entry {
  std::string name;
  std::optional<glm::vec3> ambient;
  glm::vec3 diffuse{0.7F};
  glm::vec3 specular{0.0F};
  glm::vec3 emission{0.0F};
  glm::vec3 filter{1.0F};
  float shininess = 32.0F;
  float ior = 1.5F;
  float opacity = 1.0F;
  std::optional<int> model;
};

Material meaning_of(const Entry& entry) {
  Material m;
  m.name = entry.name;
  m.diffuse = entry.diffuse;
  m.ambient = entry.ambient.value_or(entry.diffuse) * kAmbientShare;
  m.specular = entry.specular;
  m.shininess = entry.shininess;
  m.ior = entry.ior;
  m.emission = entry.emission;
  const int model = entry.model.value_or(2);
  const bool glass = model == 4 || model == 6 || model == 7 || model == 9;
  if (model == 0) {
    m.emission = entry.diffuse + entry.emission;
    m.diffuse = m.ambient = m.specular = glm::vec3(0.0F);
  }
  if (model == 1) {
    m.specular = glm::vec3(0.0F);
  }
  if (model == 3 || model == 5) {
    m.mirror = entry.specular;
  }
  if (glass) {
    m.transmission = entry.filter;
  } else if (entry.opacity < 1.0F) {
    m.transmission = entry.filter * (1.0F - entry.opacity);
    m.ior = 1.0F;
  }
  m.diffuse *= entry.opacity;
  m.ambient *= entry.opacity;
  return m;
}

class MtlReader {
 public:
  MtlReader(std::string_view text, const std::string& name, Scene& scene, MaterialIndex& index)
      : lines_(text, true), name_(name), scene_(scene), index_(index) {}

  Result<void> read() {
    while (const auto line = lines_.next()) {
      if (const auto ok = statement(*line); !ok) {
        return ok;
      }
    }
    close_entry();
    if (textures_ > 0) {
      scene_.warnings.push_back(fmt::format("{}:{}: textures are left out ({} in this file)", name_,
                                            first_texture_, textures_));
    }
    if (clamped_ > 0) {
      scene_.warnings.push_back(
          fmt::format("{}:{}: value outside its range is moved into it ({} in this file)", name_,
                      first_clamped_, clamped_));
    }
    return {};
  }

 private:
  std::unexpected<Error> bad(const std::string& what, std::string advice = {}) const {
    return fail(ErrorKind::kInput, fmt::format("{}:{}: {}", name_, lines_.number(), what),
                std::move(advice));
  }

  Result<void> statement(std::string_view line) {
    const std::string_view keyword = next_token(line);
    if (keyword.empty() || keyword.front() == '#') {
      return {};
    }
    if (keyword == "newmtl") {
      close_entry();
      entry_ = Entry{};
      entry_->name = std::string(trim(line));
      return {};
    }
    if (is_texture(keyword)) {
      first_texture_ = textures_++ == 0 ? lines_.number() : first_texture_;
      return {};
    }
    if (std::find(kNoEffect.begin(), kNoEffect.end(), keyword) != kNoEffect.end()) {
      return {};
    }
    if (!entry_) {
      return bad(fmt::format("'{}' before any newmtl", shorten(keyword)), "is this an MTL file?");
    }
    return property(*entry_, keyword, line);
  }

  static bool is_texture(std::string_view keyword) {
    return keyword.starts_with("map_") || keyword.starts_with("bump") ||
           keyword.starts_with("norm") || keyword == "disp" || keyword == "decal" ||
           keyword == "refl";
  }

  Result<void> property(Entry& entry, std::string_view keyword, std::string_view line) {
    if (keyword == "Ka") {
      return colour(line, entry.ambient.emplace(0.0F), 1.0F);
    }
    if (keyword == "Kd") {
      return colour(line, entry.diffuse, 1.0F);
    }
    if (keyword == "Ks") {
      return colour(line, entry.specular, 1.0F);
    }
    if (keyword == "Ke") {
      return colour(line, entry.emission, kMaxEmission);
    }
    if (keyword == "Tf") {
      return colour(line, entry.filter, 1.0F);
    }
    if (keyword == "Ns") {
      return number(line, entry.shininess, 0.0F, kMaxShininess);
    }
    if (keyword == "Ni") {
      return number(line, entry.ior, kMinIor, kMaxIor);
    }
    if (keyword == "d") {
      std::string_view rest = line;
      if (next_token(rest) == "-halo") {
        line = rest;
      }
      return number(line, entry.opacity, 0.0F, 1.0F);
    }
    if (keyword == "Tr") {
      const auto ok = number(line, entry.opacity, 0.0F, 1.0F);
      entry.opacity = 1.0F - entry.opacity;
      return ok;
    }
    if (keyword == "illum") {
      const auto model = parse_integer(next_token(line));
      if (!model || *model < 0 || *model > kLastModel) {
        return bad("illum is not a whole number from 0 to 10");
      }
      entry.model = static_cast<int>(*model);
      return {};
    }
    return bad(fmt::format("unknown statement '{}'", shorten(keyword)),
               "is this an MTL file? A statement of another program's can be deleted");
  }

  float clamp(float value, float low, float high) {
    if (value < low || value > high) {
      first_clamped_ = clamped_++ == 0 ? lines_.number() : first_clamped_;
    }
    return std::clamp(value, low, high);
  }

  Result<void> number(std::string_view line, float& value, float low, float high) {
    const auto parsed = parse_float(next_token(line));
    if (!parsed) {
      return bad(parsed.error().message);
    }
    value = clamp(*parsed, low, high);
    return {};
  }

  Result<void> colour(std::string_view line, glm::vec3& value, float high) {
    std::string_view rest = line;
    const std::string_view first = next_token(rest);
    if (first == "spectral" || first == "xyz") {
      scene_.warnings.push_back(
          fmt::format("{}:{}: a colour given as {} is left out", name_, lines_.number(), first));
      return {};
    }
    for (int i = 0; i < 3; ++i) {
      const std::string_view token = next_token(line);
      if (i == 1 && (token.empty() || token.front() == '#')) {
        value = glm::vec3(value.x);  // one number stands for all three
        return {};
      }
      const auto parsed = parse_float(token);
      if (!parsed) {
        return bad(parsed.error().message);
      }
      value[i] = clamp(*parsed, 0.0F, high);
    }
    return {};
  }

  void close_entry() {
    if (!entry_) {
      return;
    }
    if (index_.contains(entry_->name)) {
      scene_.warnings.push_back(fmt::format("{}: material '{}' is defined again; the first counts",
                                            name_, shorten(entry_->name)));
    } else {
      index_.emplace(entry_->name, add_material(scene_, meaning_of(*entry_)));
    }
    entry_.reset();
  }

  static constexpr float kMaxEmission = 1e6F;
  static constexpr float kMaxShininess = 1e6F;
  static constexpr float kMinIor = 0.01F;
  static constexpr float kMaxIor = 100.0F;

  LineReader lines_;
  const std::string& name_;
  Scene& scene_;
  MaterialIndex& index_;
  std::optional<Entry> entry_;
  std::size_t textures_ = 0;
  std::size_t first_texture_ = 0;
  std::size_t clamped_ = 0;
  std::size_t first_clamped_ = 0;
};

}  // namespace

Result<void> read_mtl(std::string_view text, const std::string& name, Scene& scene,
                      MaterialIndex& index) {
  return MtlReader(text, name, scene, index).read();
}

}  // namespace gridrt::scene_detail
