// What every contract test starts from: the device's name, and how answers are compared.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "host/driver/device.hpp"
#include "host/image/image.hpp"
#include "tests/contract/awkward.hpp"

namespace gridrt::contract {

/// Bit for bit, NaN included.
bool same(const Hit& a, const Hit& b);

/// The devices under test (adversarial/devices.hpp), and each schedule that one has besides its
/// default: NAME or NAME+SCHEDULE; mpi+groups has its ranks in groups.
std::vector<std::string> contract_devices();

/// A test of one device.
class Contract : public testing::TestWithParam<std::string> {
 protected:
  /// The device under test; a failure fails the test.
  static std::unique_ptr<Device> open(DeviceOptions options = {});

  /// What the device under test can do. Asked once: some devices can be opened by one at a time.
  static protocol::CapabilitiesReport capabilities();

  /// The default lattice bits, or as many as the device under test has.
  static int bits();

  /// Image options that fit the device under test, on a grid of 6x6x6 voxels, without the scene
  /// section; bits 0: bits(); pes 0: four, or as many as it has.
  static ImageOptions plain(int bits = 0, int pes = 0);

  /// True if the device takes the image. One that goes beyond it (is_beyond) marks the test as
  /// skipped; any other refusal fails it. On false the test returns.
  static bool loads(Device& device, const Image& image);

  /// Opens, loads and traces. Nothing where the image goes beyond the device (refused before
  /// anything is sent); `refused` says why.
  static std::vector<Hit> answers(const DeviceOptions& options, const Image& image,
                                  std::span<const Segment> segments, Query query,
                                  std::string& refused);
};

/// Expects the same bits; the message names the first ray that differs.
void expect_same(std::span<const Hit> got, std::span<const Hit> expected, const std::string& what);

}  // namespace gridrt::contract
