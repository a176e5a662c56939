#include "host/scene/teapot_patches.hpp"

#include <array>
#include <span>

namespace gridrt::scene_detail {
namespace {

// Newell's control points are listed by their symmetry. A ring stands for the twelve points that
// the quarter (r, 0), (r, -h), (h, -r), (0, -r) at height z gives by turning.
struct Ring {
  double r;
  double h;
  double z;
};

constexpr std::array<Ring, 13> kPot = {{{1.4, 0.784, 2.4},  // rim
                                        {1.3375, 0.749, 2.53125},
                                        {1.4375, 0.805, 2.53125},
                                        {1.5, 0.84, 2.4},  // body
                                        {1.75, 0.98, 1.875},
                                        {2.0, 1.12, 1.35},
                                        {2.0, 1.12, 0.9},
                                        {2.0, 1.12, 0.45},
                                        {1.5, 0.84, 0.225},
                                        {1.5, 0.84, 0.15},  // bottom; a later addition
                                        {1.5, 0.84, 0.075},
                                        {1.425, 0.798, 0.0},
                                        {0.0, 0.0, 0.0}}};
constexpr std::array<Ring, 7> kLid = {{{0.0, 0.0, 3.15},
                                       {0.8, 0.45, 3.15},
                                       {0.0, 0.0, 2.85},
                                       {0.2, 0.112, 2.7},
                                       {0.4, 0.224, 2.55},
                                       {1.3, 0.728, 2.55},
                                       {1.3, 0.728, 2.4}}};

// A rib stands for the six points of two halves: (ax, 0, az), (ax, -w, az), (bx, -w, bz),
// (bx, 0, bz), and back with +w.
struct Rib {
  double ax;
  double az;
  double bx;
  double bz;
  double w;
};

constexpr std::array<Rib, 7> kHandle = {{{-1.6, 2.025, -1.5, 2.25, 0.3},
                                         {-2.3, 2.025, -2.5, 2.25, 0.3},
                                         {-2.7, 2.025, -3.0, 2.25, 0.3},
                                         {-2.7, 1.8, -3.0, 1.8, 0.3},
                                         {-2.7, 1.575, -3.0, 1.35, 0.3},
                                         {-2.5, 1.125, -2.65, 0.9375, 0.3},
                                         {-2.0, 0.9, -1.9, 0.6, 0.3}}};
constexpr std::array<Rib, 7> kSpout = {{{1.7, 1.425, 1.7, 0.6, 0.66},
                                        {2.6, 1.425, 3.1, 0.825, 0.66},
                                        {2.3, 2.1, 2.4, 2.025, 0.25},
                                        {2.7, 2.4, 3.3, 2.4, 0.25},
                                        {2.8, 2.475, 3.525, 2.49375, 0.25},
                                        {2.9, 2.475, 3.45, 2.5125, 0.15},
                                        {2.8, 2.4, 3.2, 2.4, 0.15}}};

ControlTube tube_of(std::span<const Ring> rings, const glm::dvec3& pole_normal) {
  ControlTube tube;
  tube.rows = rings.size();
  tube.columns = 12;
  tube.first_row_is_pole = rings.front().r == 0.0;
  tube.last_row_is_pole = rings.back().r == 0.0;
  tube.pole_normal = pole_normal;
  for (const auto& [r, h, z] : rings) {
    const std::array<glm::dvec3, 12> turned = {{{r, 0.0, z},
                                                {r, -h, z},
                                                {h, -r, z},
                                                {0.0, -r, z},
                                                {-h, -r, z},
                                                {-r, -h, z},
                                                {-r, 0.0, z},
                                                {-r, h, z},
                                                {-h, r, z},
                                                {0.0, r, z},
                                                {h, r, z},
                                                {r, h, z}}};
    tube.points.insert(tube.points.end(), turned.begin(), turned.end());
  }
  return tube;
}

ControlTube tube_of(std::span<const Rib> ribs) {
  ControlTube tube;
  tube.rows = ribs.size();
  tube.columns = 6;
  for (const auto& [ax, az, bx, bz, w] : ribs) {
    const std::array<glm::dvec3, 6> around = {
        {{ax, 0.0, az}, {ax, -w, az}, {bx, -w, bz}, {bx, 0.0, bz}, {bx, w, bz}, {ax, w, az}}};
    tube.points.insert(tube.points.end(), around.begin(), around.end());
  }
  return tube;
}

}  // namespace

std::vector<ControlTube> teapot_tubes() {
  return {tube_of(kPot, {0.0, 0.0, -1.0}), tube_of(kLid, {0.0, 0.0, 1.0}), tube_of(kHandle),
          tube_of(kSpout)};
}

}  // namespace gridrt::scene_detail
