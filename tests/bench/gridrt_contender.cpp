#include <algorithm>
#include <stdexcept>

#include "host/driver/image_options.hpp"
#include "host/driver/ray_records.hpp"
#include "host/grid/parallel.hpp"
#include "host/grid/segments.hpp"
#include "host/image/image.hpp"
#include "host/image/image_file.hpp"
#include "host/pe/schedule_rays.hpp"
#include "tests/bench/contender.hpp"

namespace gridrt::bench {
namespace {

template <class T>
T valid(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

/// The image within a device, without the link to it.
std::unique_ptr<CommittedImage> commit(const Image& image) {
  ImageStore store;
  const auto add = [&](protocol::SectionKind kind, std::uint8_t pe,
                       std::span<const std::byte> bytes) {
    protocol::LoadHead head;
    head.kind = static_cast<std::uint8_t>(kind);
    head.pe = pe;
    head.total = static_cast<std::uint32_t>(bytes.size());
    head.bytes = head.total;
    if (!store.add(head, bytes)) throw std::runtime_error("a section is refused");
  };
  const std::vector<std::byte> header = header_section(image);
  add(protocol::SectionKind::kHeader, 0, header);
  for (const ImageSection& s : image.sections) {
    if (s.kind == protocol::SectionKind::kIds || s.kind == protocol::SectionKind::kScene) continue;
    add(s.kind, s.pe, s.bytes);
  }
  auto committed = store.commit(~std::uint64_t{0});
  if (!committed) throw std::runtime_error("the image is refused");
  return std::move(*committed);
}

class GridRT final : public Contender {
 public:
  explicit GridRT(const GridrtChoice& choice)
      : part_(choice.part), simd_(choice.simd), bits_(choice.bits) {}

  [[nodiscard]] std::string name() const override {
    const char* const part = part_ == Part::kPes      ? "PEs alone"
                             : part_ == Part::kDevice ? "segments to hits"
                                                      : "rays to hits";
    return std::string("GridRT, ") + part + (simd_.empty() ? "" : ", " + simd_);
  }

  void build(const Scene& scene, int threads) override {
    ImageOptions options;
    options.with_scene = false;
    options.bits = bits_;
    options.threads = threads;
    open(threads);
    const Image image = valid(build_image(scene, options_for(options, device_->capabilities())));
    lattice_ = image.lattice();
    if (const auto loaded = device_->load(image); !loaded) {
      throw std::runtime_error(loaded.error().message);
    }
    if (part_ == Part::kPes) {
      image_ = commit(image);
      if (simd_ != "plain") image_->stream = make_stream(*image_, simd_, threads);
      global_ids_ = valid(decode_triangles(image)).global_ids;
    }
    layout_ = static_cast<protocol::Layout>(image.header.layout);
    built_ = std::make_unique<Image>(image);
  }

  void prepare(const RaySet& set) override {
    rays_ = set.rays;
    segments_.resize(rays_.size());
    hits_.resize(rays_.size());
    for (std::size_t i = 0; i < rays_.size(); ++i) segments_[i] = make_segment(lattice_, rays_[i]);
    if (part_ != Part::kPes) return;
    batch_.clear();
    places_.clear();
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (segments_[i].is_miss()) continue;
      batch_.push_back({{segments_[i].p0, segments_[i].p1}});
      places_.push_back(i);
    }
    records_.resize(batch_.size() * hit_record_bytes(layout_));
  }

  void trace(int threads) override {
    if (part_ == Part::kPes) {
      PeCounters counters;
      trace_rays(*image_, batch_, records_, threads, counters);
      return;
    }
    if (threads != threads_) {
      open(threads);
      if (!device_->load(*built_)) throw std::runtime_error("the image does not load again");
    }
    if (part_ == Part::kProgram) {
      parallel_pieces(threads, rays_.size(), [&](std::size_t first, std::size_t last) {
        make_segments(lattice_, std::span(rays_).subspan(first, last - first),
                      std::span(segments_).subspan(first, last - first));
      });
    }
    if (const auto done = device_->trace(segments_, Query::kClosestHit, hits_); !done) {
      throw std::runtime_error(done.error().message);
    }
  }

  [[nodiscard]] std::vector<std::int32_t> ids() const override {
    std::vector<std::int32_t> out(rays_.size(), -1);
    if (part_ != Part::kPes) {
      std::ranges::transform(hits_, out.begin(), [](const Hit& hit) { return hit.id; });
      return out;
    }
    const std::size_t bytes = hit_record_bytes(layout_);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const DeviceHit hit = unpack_hit(layout_, std::span(records_).subspan(i * bytes, bytes));
      if (hit.hit) out[places_[i]] = static_cast<std::int32_t>(global_ids_[hit.id]);
    }
    return out;
  }

 private:
  void open(int threads) {
    if (device_ && threads == threads_) return;
    threads_ = threads;
    DeviceOptions options;
    options.name = "omp";
    options.threads = threads;
    options.simd = simd_;
    device_ = valid(open_device(options));
  }

  Part part_;
  std::string simd_;
  int bits_;
  int threads_ = 0;
  std::unique_ptr<Device> device_;
  std::unique_ptr<CommittedImage> image_;
  std::unique_ptr<Image> built_;
  protocol::Layout layout_ = protocol::Layout::kNone;
  Lattice lattice_;
  std::vector<Ray> rays_;
  std::vector<Segment> segments_;
  std::vector<Hit> hits_;
  std::vector<BatchRay> batch_;
  std::vector<std::size_t> places_;
  std::vector<std::byte> records_;
  std::vector<std::uint32_t> global_ids_;
};

}  // namespace

std::unique_ptr<Contender> gridrt_contender(const GridrtChoice& choice) {
  return std::make_unique<GridRT>(choice);
}

}  // namespace gridrt::bench
