#include "tests/contract/fixture.hpp"

#include <algorithm>
#include <bit>
#include <map>

#include "host/driver/image_options.hpp"
#include "host/mpi/connect.hpp"
#include "tests/adversarial/bench.hpp"
#include "tests/adversarial/devices.hpp"

namespace gridrt::contract {

bool same(const Hit& a, const Hit& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  return a.id == b.id && bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v);
}

namespace {

/// By device, what one that was opened has said.
std::map<std::string, protocol::CapabilitiesReport>& known() {
  static std::map<std::string, protocol::CapabilitiesReport> map;
  return map;
}

/// As few groups as mpi's ranks can be split into, but more than one if they can.
int groups_of_ranks() {
  const int job = ranks_of_this_job();
  const int ranks = job > 0 ? job : kDefaultRanks;
  int groups = ranks > 1 ? 2 : 1;
  while (ranks % groups != 0) ++groups;
  return groups;
}

}  // namespace

std::vector<std::string> contract_devices() {
  std::vector<std::string> names = adversarial::devices_under_test();
  for (const std::string& name : adversarial::devices_under_test()) {
    if (name == "omp") names.insert(names.end(), {"omp+pes", "omp+paper"});
    if (name == "mpi") names.insert(names.end(), {"mpi+paper", "mpi+groups"});
  }
  return names;
}

std::unique_ptr<Device> Contract::open(DeviceOptions options) {
  const std::string& name = GetParam();
  const std::size_t cut = name.find('+');
  options.name = name.substr(0, cut);
  const std::string way = cut == std::string::npos ? "" : name.substr(cut + 1);
  if (way == "groups") {
    options.groups = groups_of_ranks();
  } else {
    options.schedule = way;
  }
  auto device = open_device(options);
  if (!device) {
    ADD_FAILURE() << device.error().message;
    return nullptr;
  }
  EXPECT_EQ((*device)->name(), options.name);
  if (!options.capabilities) known()[name] = (*device)->capabilities();
  return std::move(*device);
}

protocol::CapabilitiesReport Contract::capabilities() {
  if (!known().contains(GetParam())) open();
  return known()[GetParam()];
}

int Contract::bits() {
  const int most = capabilities().max_bits;
  return most == 0 ? kDefaultBits : std::min(kDefaultBits, most);
}

ImageOptions Contract::plain(int bits, int pes) {
  ImageOptions options;
  options.bits = bits == 0 ? Contract::bits() : bits;
  options.with_scene = false;
  // Measured cuts take long to make; one test has them.
  options.mapping = Mapping::kBoxes;
  options.grid = glm::ivec3{6};
  const protocol::CapabilitiesReport device = capabilities();
  if (device.pes == 0) return options;
  options.pes = pes == 0 ? std::min<int>(4, device.pes) : pes;
  return options_for(options, device);
}

bool Contract::loads(Device& device, const Image& image) {
  const auto loaded = device.load(image);
  if (loaded) return true;
  const Error& error = loaded.error();
  if (adversarial::is_beyond(image, device.capabilities())) {
    [&] { GTEST_SKIP() << error.message; }();
  } else {
    ADD_FAILURE() << error.message;
  }
  return false;
}

std::vector<Hit> Contract::answers(const DeviceOptions& options, const Image& image,
                                   std::span<const Segment> segments, Query query,
                                   std::string& refused) {
  refused.clear();
  const auto device = open(options);
  if (!device) return {};
  const auto loaded = device->load(image);
  if (!loaded) {
    const ErrorKind kind = loaded.error().kind;
    EXPECT_TRUE(kind == ErrorKind::kLimit || kind == ErrorKind::kUnsupported)
        << loaded.error().message;
    EXPECT_TRUE(adversarial::is_beyond(image, device->capabilities())) << loaded.error().message;
    const auto counters = device->counters();
    EXPECT_TRUE(counters && counters->bytes_out == 0) << "something was sent";
    refused = loaded.error().message;
    return {};
  }
  return trace(*device, segments, query);
}

void expect_same(std::span<const Hit> got, std::span<const Hit> expected, const std::string& what) {
  ASSERT_EQ(got.size(), expected.size()) << what;
  for (std::size_t i = 0; i < got.size(); ++i) {
    ASSERT_TRUE(same(got[i], expected[i]))
        << what << ": ray " << i << ": id " << got[i].id << ", t " << got[i].t << ", u " << got[i].u
        << ", v " << got[i].v << "; seq: id " << expected[i].id << ", t " << expected[i].t << ", u "
        << expected[i].u << ", v " << expected[i].v;
  }
}

}  // namespace gridrt::contract
