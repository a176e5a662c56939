#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <embree3/rtcore.h>

#include "tests/bench/contender.hpp"

namespace gridrt::bench {
namespace {

constexpr std::ptrdiff_t kPiece = 1024;  // rays that a thread takes at a time

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

struct FloatRay {
  std::array<float, 3> origin;
  std::array<float, 3> direction;
};

/// One record for one call of Embree: W rays, W = 1 or a packet.
template <int W>
struct Call;
template <>
struct Call<1> {
  using Record = RTCRayHit;
  static void put(Record& r, int /*lane*/, const FloatRay& ray) {
    r.ray.org_x = ray.origin[0];
    r.ray.org_y = ray.origin[1];
    r.ray.org_z = ray.origin[2];
    r.ray.dir_x = ray.direction[0];
    r.ray.dir_y = ray.direction[1];
    r.ray.dir_z = ray.direction[2];
    r.ray.tnear = 0.0F;
    r.ray.tfar = INFINITY;
    r.ray.time = 0.0F;
    r.ray.mask = ~0U;
    r.ray.flags = 0;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  }
  static void run(const int* /*valid*/, RTCScene scene, RTCIntersectContext* context, Record& r) {
    rtcIntersect1(scene, context, &r);
  }
  static Hit hit(const Record& r, int /*lane*/) {
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {static_cast<std::int32_t>(r.hit.primID), r.ray.tfar, r.hit.u, r.hit.v};
  }
};

template <class R, auto Intersect>
struct PacketCall {
  using Record = R;
  static void put(Record& r, int i, const FloatRay& ray) {
    r.ray.org_x[i] = ray.origin[0];
    r.ray.org_y[i] = ray.origin[1];
    r.ray.org_z[i] = ray.origin[2];
    r.ray.dir_x[i] = ray.direction[0];
    r.ray.dir_y[i] = ray.direction[1];
    r.ray.dir_z[i] = ray.direction[2];
    r.ray.tnear[i] = 0.0F;
    r.ray.tfar[i] = INFINITY;
    r.ray.time[i] = 0.0F;
    r.ray.mask[i] = ~0U;
    r.ray.flags[i] = 0;
    r.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  }
  static void run(const int* valid, RTCScene scene, RTCIntersectContext* context, Record& r) {
    Intersect(valid, scene, context, &r);
  }
  static Hit hit(const Record& r, int i) {
    if (r.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) return {};
    return {static_cast<std::int32_t>(r.hit.primID[i]), r.ray.tfar[i], r.hit.u[i], r.hit.v[i]};
  }
};
template <>
struct Call<8> : PacketCall<RTCRayHit8, rtcIntersect8> {};
template <>
struct Call<16> : PacketCall<RTCRayHit16, rtcIntersect16> {};

template <int W>
class Embree final : public Contender {
 public:
  explicit Embree(bool robust) : robust_(robust) {}

  [[nodiscard]] std::string name() const override {
    std::string name = W == 1 ? "Embree, single rays" : "Embree, packets of " + std::to_string(W);
    return robust_ ? name + ", robust" : name;
  }

  void build(const Scene& scene, int threads) override {
    scene_.reset();
    if (!device_ || threads != threads_) {
      threads_ = threads;
      device_.reset(rtcNewDevice(("threads=" + std::to_string(threads)).c_str()));
      if (!device_) throw std::runtime_error("Embree does not start");
    }
    RTCGeometry mesh = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(glm::vec3), scene.positions.size());
    std::copy_n(scene.positions.data(), scene.positions.size(), static_cast<glm::vec3*>(vertices));
    using Triple = std::array<std::uint32_t, 3>;
    void* triangles = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(Triple), scene.triangles.size());
    std::copy_n(scene.triangles.data(), scene.triangles.size(), static_cast<Triple*>(triangles));
    rtcCommitGeometry(mesh);
    scene_.reset(rtcNewScene(device_.get()));
    if (robust_) rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    rtcAttachGeometry(scene_.get(), mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene_.get());
  }

  void prepare(const RaySet& set) override {
    coherent_ = set.coherent;
    rays_.clear();
    for (const Ray& ray : set.rays) {
      FloatRay& to = rays_.emplace_back();
      for (int a = 0; a < 3; ++a) {
        to.origin[static_cast<std::size_t>(a)] = static_cast<float>(ray.origin[a]);
        to.direction[static_cast<std::size_t>(a)] = static_cast<float>(ray.direction[a]);
      }
    }
    hits_.resize(rays_.size());
  }

  void trace(int threads) override {
    const auto n = static_cast<std::ptrdiff_t>(rays_.size());
#pragma omp parallel for num_threads(threads) if (threads > 1) schedule(dynamic)
    for (std::ptrdiff_t piece = 0; piece < (n + kPiece - 1) / kPiece; ++piece) {
      trace_piece(piece * kPiece, std::min(n, (piece + 1) * kPiece));
    }
  }

  [[nodiscard]] std::vector<std::int32_t> ids() const override {
    std::vector<std::int32_t> out;
    for (const Hit& hit : hits_) out.push_back(hit.id);
    return out;
  }

 private:
  void trace_piece(std::ptrdiff_t first, std::ptrdiff_t last) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags =
        coherent_ ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    typename Call<W>::Record record;
    std::array<int, W> valid{};
    for (std::ptrdiff_t i = first; i < last; i += W) {
      const int count = static_cast<int>(std::min<std::ptrdiff_t>(W, last - i));
      for (int lane = 0; lane < W; ++lane) {
        valid[static_cast<std::size_t>(lane)] = lane < count ? -1 : 0;
        Call<W>::put(record, lane, rays_[static_cast<std::size_t>(i + std::min(lane, count - 1))]);
      }
      Call<W>::run(valid.data(), scene_.get(), &context, record);
      for (int lane = 0; lane < count; ++lane) {
        hits_[static_cast<std::size_t>(i + lane)] = Call<W>::hit(record, lane);
      }
    }
  }

  bool robust_;
  int threads_ = 0;
  bool coherent_ = false;
  std::unique_ptr<RTCDeviceTy, Release> device_;
  std::unique_ptr<RTCSceneTy, Release> scene_;
  std::vector<FloatRay> rays_;
  std::vector<Hit> hits_;
};

}  // namespace

std::unique_ptr<Contender> embree_contender(int width, bool robust) {
  if (width == 1) return std::make_unique<Embree<1>>(robust);
  if (width == 8) return std::make_unique<Embree<8>>(robust);
  return std::make_unique<Embree<16>>(robust);
}

}  // namespace gridrt::bench
