#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <glm/geometric.hpp>

#include "host/grid/traversal.hpp"
#include "host/grid/voxel_grid.hpp"
#include "tests/bench/contender.hpp"

namespace gridrt::bench {
namespace {

/// Moeller and Trumbore's test ("Fast, Minimum Storage Ray/Triangle Intersection", 1997) as it is
/// usually written, two-sided, without an epsilon.
template <class Real>
struct PlainTriangle {
  using Vector = glm::vec<3, Real>;
  Vector v0, e1, e2;

  [[nodiscard]] Real meet(const Vector& origin, const Vector& direction) const {
    constexpr Real kMiss = std::numeric_limits<Real>::infinity();
    const Vector p = glm::cross(direction, e2);
    const Real det = glm::dot(e1, p);
    if (det == Real{0}) return kMiss;
    const Real inverse = Real{1} / det;
    const Vector t = origin - v0;
    const Real u = glm::dot(t, p) * inverse;
    if (u < Real{0} || u > Real{1}) return kMiss;
    const Vector q = glm::cross(t, e1);
    const Real v = glm::dot(direction, q) * inverse;
    if (v < Real{0} || u + v > Real{1}) return kMiss;
    const Real at = glm::dot(e2, q) * inverse;
    return at >= Real{0} ? at : kMiss;
  }
};

template <class Real>
class Floating final : public Contender {
 public:
  [[nodiscard]] std::string name() const override {
    return sizeof(Real) == 4 ? "Moeller-Trumbore, fp32" : "Moeller-Trumbore, fp64";
  }

  void build(const Scene& scene, int /*threads*/) override {
    triangles_.clear();
    std::vector<LatticeTriangle> snapped;
    lattice_ = make_lattice(scene.positions, scene.triangles, kDefaultBits).value();
    for (const auto& t : scene.triangles) {
      std::array<typename PlainTriangle<Real>::Vector, 3> v;
      LatticeTriangle q;
      for (std::size_t k = 0; k < 3; ++k) {
        v[k] = typename PlainTriangle<Real>::Vector(scene.positions[t[k]]);
        q.v[k] = snap(lattice_, scene.positions[t[k]]);
      }
      triangles_.push_back({v[0], v[1] - v[0], v[2] - v[0]});
      snapped.push_back(q);
    }
    grid_ = make_grid(lattice_, snapped.size(), {}).value();
    grid_.margin = 3;  // the ray on the lattice and the ray itself are not quite the same
    lists_ = bin_triangles(grid_, snapped);
  }

  void prepare(const RaySet& set) override {
    rays_ = set.rays;
    ids_.resize(rays_.size());
  }

  void trace(int threads) override {
    const auto n = static_cast<std::ptrdiff_t>(rays_.size());
#pragma omp parallel for num_threads(threads) if (threads > 1) schedule(dynamic, 1024)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      ids_[static_cast<std::size_t>(i)] = trace_one(rays_[static_cast<std::size_t>(i)]);
    }
  }

  [[nodiscard]] std::vector<std::int32_t> ids() const override { return ids_; }

 private:
  [[nodiscard]] std::int32_t trace_one(const Ray& ray) const {
    using Vector = typename PlainTriangle<Real>::Vector;
    const Segment segment = make_segment(lattice_, ray);
    if (segment.is_miss()) return -1;
    const Vector origin(ray.origin);
    const Vector direction(ray.direction);
    std::int32_t best = -1;
    Real nearest = std::numeric_limits<Real>::infinity();
    traverse(
        grid_, segment.p0, segment.p1, [](const glm::ivec3&, int) { return 0; },
        [&](const VoxelVisit& visit) {
          // What lies before this voxel, and a little behind its entry, is settled.
          const double enter =
              static_cast<double>(visit.enter.num) / static_cast<double>(visit.enter.den) - 0x1p-14;
          if (nearest < segment.t0 + (segment.t1 - segment.t0) * enter) return false;
          const std::size_t cell = grid_.index(visit.voxel);
          for (std::uint64_t r = lists_.first[cell]; r < lists_.first[cell + 1]; ++r) {
            const std::uint32_t id = lists_.references[r].triangle;
            const Real t = triangles_[id].meet(origin, direction);
            const bool first = t == nearest && static_cast<std::int32_t>(id) < best;
            if (t < nearest || first) {
              nearest = t;
              best = static_cast<std::int32_t>(id);
            }
          }
          return true;
        });
    return best;
  }

  Lattice lattice_;
  VoxelGrid grid_;
  VoxelLists lists_;
  std::vector<PlainTriangle<Real>> triangles_;
  std::vector<Ray> rays_;
  std::vector<std::int32_t> ids_;
};

}  // namespace

std::unique_ptr<Contender> floating_contender(Precision precision) {
  if (precision == Precision::kSingle) return std::make_unique<Floating<float>>();
  return std::make_unique<Floating<double>>();
}

}  // namespace gridrt::bench
