#include "host/scene/builtin.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/scene/assemble.hpp"
#include "host/scene/load.hpp"
#include "host/scene/number.hpp"
#include "host/scene/readers.hpp"
#include "host/scene/text.hpp"

namespace gridrt {
namespace scene_detail {
namespace {

constexpr BuiltinOption kLightsOption{
    "lights", OptionKind::kInteger, "1", 0, 1, "0: none; 1: those of the scene, or default ones"};

// All scenes by name, each with the option `lights`.
std::vector<Builtin> all_builtins() {
  std::vector<Builtin> all;
  for (auto group : {shape_builtins(), teapot_builtins(), whitted_builtins(), room_builtins(),
                     hard_builtins()}) {
    std::move(group.begin(), group.end(), std::back_inserter(all));
  }
  std::sort(all.begin(), all.end(), [](const Builtin& a, const Builtin& b) {
    return std::string_view(a.name) < std::string_view(b.name);
  });
  for (Builtin& builtin : all) {
    builtin.options.push_back(kLightsOption);
  }
  return all;
}

// "a|b" out of "a|b: what it does".
std::string choices_of(const BuiltinOption& option) {
  const std::string_view help = option.help;
  return std::string(help.substr(0, help.find(':')));
}

bool is_choice(const BuiltinOption& option, std::string_view value) {
  const std::string choices = fmt::format("|{}|", choices_of(option));
  return !value.empty() && value.find('|') == std::string_view::npos &&
         choices.find(fmt::format("|{}|", value)) != std::string::npos;
}

std::optional<double> number_in_range(const BuiltinOption& option, std::string_view text) {
  const auto value = parse_double(text);
  const bool whole = option.kind != OptionKind::kInteger || (value && *value == std::floor(*value));
  if (!value || !whole || *value < option.lowest || *value > option.highest) {
    return std::nullopt;
  }
  return *value;
}

Result<void> set_option(BuiltinValues& values, const BuiltinOption& option, std::string_view text,
                        std::string_view spec) {
  const auto wrong = [&](const std::string& advice) {
    return fail(ErrorKind::kUsage,
                fmt::format("builtin:{}: '{}' is no value of {}", shorten(spec), shorten(text),
                            option.name),
                advice);
  };
  if (option.kind == OptionKind::kChoice) {
    if (!is_choice(option, text)) {
      return wrong(fmt::format("give one of {}", choices_of(option)));
    }
    values.set(option.name, std::string(text));
    return {};
  }
  const auto range = fmt::format("from {} to {}", option.lowest, option.highest);
  if (option.kind != OptionKind::kVector) {
    const auto number = number_in_range(option, text);
    if (!number) {
      const bool whole = option.kind == OptionKind::kInteger;
      return wrong(fmt::format("give a {} {}", whole ? "whole number" : "number", range));
    }
    values.set(option.name, glm::dvec3(*number));
    return {};
  }
  glm::dvec3 vector(0.0);
  std::string_view rest = text;
  for (int i = 0; i < 3; ++i) {
    const std::size_t comma = rest.find(',');
    const auto number = number_in_range(option, rest.substr(0, comma));
    if (!number || (comma == std::string_view::npos) != (i == 2)) {
      return wrong(fmt::format("give three numbers x,y,z {}", range));
    }
    vector[i] = *number;
    rest.remove_prefix(i == 2 ? rest.size() : comma + 1);
  }
  values.set(option.name, vector);
  return {};
}

Result<BuiltinValues> read_options(const Builtin& builtin, std::string_view text,
                                   std::string_view spec) {
  BuiltinValues values;
  for (const BuiltinOption& option : builtin.options) {
    if (const auto ok = set_option(values, option, option.initial, spec); !ok) {
      return fail(ErrorKind::kInternal, ok.error().message, ok.error().advice);
    }
  }
  while (!text.empty()) {
    const std::string_view pair = text.substr(0, text.find('&'));
    text.remove_prefix(std::min(pair.size() + 1, text.size()));
    const std::size_t equals = pair.find('=');
    const std::string_view key = pair.substr(0, equals);
    const auto option = std::find_if(builtin.options.begin(), builtin.options.end(),
                                     [&](const BuiltinOption& o) { return key == o.name; });
    if (option == builtin.options.end() || equals == std::string_view::npos) {
      std::vector<std::string_view> names;
      names.reserve(builtin.options.size());
      for (const BuiltinOption& o : builtin.options) {
        names.emplace_back(o.name);
      }
      return fail(ErrorKind::kUsage,
                  fmt::format("builtin:{}: '{}' is no option of {}", shorten(spec), shorten(pair),
                              builtin.name),
                  fmt::format("options are {}, as key=value joined by &", fmt::join(names, ", ")));
    }
    if (const auto ok = set_option(values, *option, pair.substr(equals + 1), spec); !ok) {
      return std::unexpected(ok.error());
    }
  }
  return values;
}

}  // namespace

Result<Scene> make_builtin(std::string_view spec) {
  const std::size_t question = spec.find('?');
  const std::string_view name = spec.substr(0, question);
  const std::vector<Builtin> all = all_builtins();
  const auto builtin =
      std::find_if(all.begin(), all.end(), [&](const Builtin& b) { return name == b.name; });
  if (builtin == all.end()) {
    std::vector<std::string_view> names;
    names.reserve(all.size());
    for (const Builtin& b : all) {
      names.emplace_back(b.name);
    }
    return fail(ErrorKind::kUsage, fmt::format("builtin:{}: no such scene", shorten(spec)),
                fmt::format("built-in scenes are {}", fmt::join(names, ", ")));
  }
  const std::string_view options =
      question == std::string_view::npos ? std::string_view{} : spec.substr(question + 1);
  const auto values = read_options(*builtin, options, spec);
  if (!values) {
    return std::unexpected(values.error());
  }
  Result<Scene> made = builtin->make(*values);
  if (!made) return made;
  Scene& scene = *made;
  if (scene.materials.empty()) {
    scene.materials.emplace_back();
  }
  if (values->integer("lights") == 0) {
    scene.lights.clear();
  } else if (scene.lights.empty()) {
    add_default_lights(scene);
  }
  if (const auto ok = check_scene(scene, fmt::format("builtin:{}", shorten(spec))); !ok) {
    return std::unexpected(ok.error());
  }
  return made;
}

std::uint64_t SplitMix64::bits() {
  state_ += 0x9E3779B97F4A7C15U;
  std::uint64_t z = state_;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

double SplitMix64::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
}

}  // namespace scene_detail

std::vector<BuiltinInfo> builtin_names() {
  std::vector<BuiltinInfo> infos;
  for (const scene_detail::Builtin& builtin : scene_detail::all_builtins()) {
    BuiltinInfo info{builtin.name, builtin.summary, {}};
    for (const scene_detail::BuiltinOption& option : builtin.options) {
      info.options.push_back(fmt::format("{}={}  {}", option.name, option.initial, option.help));
    }
    infos.push_back(std::move(info));
  }
  return infos;
}

}  // namespace gridrt
