// Byte structs and constants of the generated protocol: where each byte lies.
#include <random>

#include <gtest/gtest.h>

#include "gridrt_protocol.hpp"

namespace gridrt::protocol {
namespace {

/// A byte pattern that survives load and store proves that no byte is lost or moved.
template <class T>
void expect_bijection() {
  std::mt19937 random(7);
  for (int round = 0; round < 100; ++round) {
    std::array<std::byte, T::kBytes> in{};
    for (std::byte& b : in) b = static_cast<std::byte>(random() & 0x3FU);  // floats: no NaN
    T value;
    load(in, value);
    std::array<std::byte, T::kBytes> out{};
    store(value, out);
    EXPECT_EQ(in, out);
  }
}

TEST(Structs, LoadAndStoreKeepEveryByte) {
  expect_bijection<FrameHeader>();
  expect_bijection<LoadHead>();
  expect_bijection<CommitHead>();
  expect_bijection<TraceHead>();
  expect_bijection<ErrorBody>();
  expect_bijection<ImageHeader>();
  expect_bijection<SectionEntry>();
  expect_bijection<IdentityReport>();
  expect_bijection<CapabilitiesReport>();
  expect_bijection<StatusReport>();
  expect_bijection<CountersReport>();
  expect_bijection<ResetReport>();
  expect_bijection<LogReport>();
  expect_bijection<ControlReport>();
  expect_bijection<StallsReport>();
}

TEST(Structs, FrameHeaderBytes) {
  const FrameHeader header{.magic = kFrameMagic,
                           .version = 1,
                           .type = static_cast<std::uint8_t>(FrameType::kTrace),
                           .layout = static_cast<std::uint8_t>(Layout::kWide),
                           .flags = 0,
                           .sequence = 0x04030201,
                           .length = 0x00080706,
                           .header_crc = 0xDDCCBBAA};
  std::array<std::byte, FrameHeader::kBytes> out{};
  store(header, out);
  constexpr std::array<unsigned, 20> kExpected{'G', 'R', 'F', '1', 1, 3, 2,    0,    1,    2,
                                               3,   4,   6,   7,   8, 0, 0xAA, 0xBB, 0xCC, 0xDD};
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_EQ(static_cast<unsigned>(out[i]), kExpected[i]) << i;
  }
}

TEST(Structs, ImageHeaderPlaces) {
  ImageHeader header;
  header.magic = kImageMagic;
  header.lo = {1.0F, -2.0F, 0.5F};
  header.scale = {-1, 2, -3};
  header.margin = 0x11223344;
  header.pe_bits = 0x77;
  header.reserved3 = 0x8877665544332211U;
  std::array<std::byte, ImageHeader::kBytes> out{};
  store(header, out);
  EXPECT_EQ(detail::get32(out.data()), 0x31545247U);
  EXPECT_EQ(detail::get32(out.data() + 16), 0x3F800000U);
  EXPECT_EQ(detail::get32(out.data() + 20), 0xC0000000U);
  EXPECT_EQ(detail::get32(out.data() + 24), 0x3F000000U);
  EXPECT_EQ(detail::get32(out.data() + 40), 0xFFFFFFFFU);
  EXPECT_EQ(detail::get32(out.data() + 48), 0xFFFFFFFDU);
  EXPECT_EQ(detail::get32(out.data() + 88), 0x11223344U);
  EXPECT_EQ(out[111], std::byte{0x77});
  EXPECT_EQ(out[136], std::byte{0x11});
  EXPECT_EQ(out[143], std::byte{0x88});
  EXPECT_EQ(load_image_header(out), header);
}

TEST(Structs, ReportsFitTheirTransfer) {
  EXPECT_LT(IdentityReport::kBytes, kReportBytes);
  EXPECT_LT(CapabilitiesReport::kBytes, kReportBytes);
  EXPECT_LT(StatusReport::kBytes, kReportBytes);
  EXPECT_LT(CountersReport::kBytes, kReportBytes);
  EXPECT_LT(ResetReport::kBytes, kReportBytes);
}

TEST(Enums, NamesAndKnownValues) {
  EXPECT_EQ(name(FrameType::kNoOp), "NoOp");
  EXPECT_EQ(name(SectionKind::kBlocks), "Blocks");
  EXPECT_EQ(name(ErrorCode::kBadPayloadCrc), "BadPayloadCrc");
  EXPECT_TRUE(is_known(Layout::kNone));
  EXPECT_FALSE(is_known(Layout{3}));
  EXPECT_EQ(name(FrameType{0x77}), "");
}

TEST(Layouts, LimitsOfTheBoard) {
  const LayoutLimits limits = layout_limits(Layout::kCompact);
  EXPECT_EQ(limits.max_triangles, 4096U);
  EXPECT_EQ(limits.coordinate_bits, 18U);
  EXPECT_EQ(layout_limits(Layout::kWide).coordinate_bits, 32U);
  EXPECT_EQ(layout_limits(Layout::kNone), LayoutLimits{});
}

}  // namespace
}  // namespace gridrt::protocol
