// Numbers: the float32 nearest to a decimal, as strtof has it, and clear refusals.
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "host/scene/number.hpp"

namespace gridrt::scene_detail {
namespace {

std::string printed(const char* format, double value) {
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(), format, value);
  return text.data();
}

// strtof of glibc rounds to nearest; the C locale is in force in tests.
void expect_nearest(const std::string& text) {
  const auto parsed = parse_float(text);
  const float expected = std::strtof(text.c_str(), nullptr);
  if (std::isinf(expected)) {
    EXPECT_FALSE(parsed.has_value()) << text;
    return;
  }
  ASSERT_TRUE(parsed.has_value()) << text << ": " << parsed.error().message;
  EXPECT_EQ(std::bit_cast<std::uint32_t>(*parsed), std::bit_cast<std::uint32_t>(expected)) << text;
}

float random_float(std::mt19937_64& random) {
  for (;;) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(value)) {
      return value;
    }
  }
}

TEST(SceneNumber, AgreesWithStrtofOnRandomDecimals) {
  std::mt19937_64 random(20);
  constexpr int kEach = 25'000;
  for (int i = 0; i < kEach; ++i) {
    const double unit = static_cast<double>(random() >> 11) * 0x1p-53;
    expect_nearest(printed("%.6f", unit * 20 - 10));
    expect_nearest(printed("%.9g", static_cast<double>(random_float(random))));
    expect_nearest(printed("%.17g", unit * 2000 - 1000));
    expect_nearest(
        printed("%.25e", unit * std::pow(10.0, static_cast<double>(random() % 90) - 50)));
  }
}

TEST(SceneNumber, AgreesWithStrtofBesideHalfwayCases) {
  std::mt19937_64 random(21);
  constexpr int kEach = 25'000;
  for (int i = 0; i < kEach; ++i) {
    const float low = std::abs(random_float(random));
    const float high = std::nextafter(low, INFINITY);
    if (std::isinf(high)) {
      continue;
    }
    const double half = (static_cast<double>(low) + static_cast<double>(high)) / 2;
    // All decimals of the middle (it is a tie), then a digit far behind on either side.
    const std::string tie = printed("%.160f", half);
    expect_nearest(tie);
    expect_nearest(tie + "1");
    expect_nearest(printed("%.17g", std::nextafter(half, 0.0)));
    expect_nearest(printed("%.17g", half));
  }
}

TEST(SceneNumber, AgreesWithStrtofOnHardCases) {
  for (const char* text : {"0",
                           "-0",
                           "-0.0",
                           "1",
                           "-1",
                           "+1",
                           "+.5",
                           ".5",
                           "5.",
                           "1e0",
                           "1E+2",
                           "1e-2",
                           "1.17549435e-38",
                           "1.17549428e-38",
                           "1.4e-45",
                           "7e-46",
                           "7.1e-46",
                           "1e-46",
                           "-1e-46",
                           "1e-400",
                           "-1e-400",
                           "1e-99999999999999999999",
                           "0e99999999999999999999",
                           "3.4028234663852886e38",
                           "3.40282356e38",
                           "3.4028235677973366e38",
                           "16777217",
                           "16777219",
                           "33554435",
                           "0.1",
                           "0.3",
                           "1.00000005960464477539062499999",
                           "1.000000059604644775390625",
                           "1.00000005960464477539062500001",
                           "2.3509887016445750159e-38",
                           "0.000000000000000000000000000000000000000000001"}) {
    expect_nearest(text);
  }
  expect_nearest("0." + std::string(1000, '0') + "1");
  expect_nearest("1" + std::string(1000, '0') + "e-1000");
  expect_nearest("0." + std::string(100'000, '3'));
}

TEST(SceneNumber, KeepsDenormalsAndTheSignOfZero) {
  EXPECT_EQ(*parse_float("1e-45"), std::numeric_limits<float>::denorm_min());
  EXPECT_TRUE(std::signbit(*parse_float("-0")));
  EXPECT_TRUE(std::signbit(*parse_float("-1e-60")));
  EXPECT_EQ(*parse_double("5e-324"), std::numeric_limits<double>::denorm_min());
}

TEST(SceneNumber, RefusesWhatIsNoFiniteNumber) {
  for (const char* text :
       {"",   "x",    "1x",  "1 ",  "--1",  "+-1", "++1",  "+",        "-",  ".",
        "e5", "0x10", "1,5", "nan", "-nan", "inf", "-inf", "infinity", "1e", "+inf"}) {
    EXPECT_FALSE(parse_float(text).has_value()) << text;
    EXPECT_FALSE(parse_double(text).has_value()) << text;
  }
  EXPECT_NE(parse_float("nan").error().message.find("finite"), std::string::npos);
}

TEST(SceneNumber, RefusesWhatIsBeyondTheRange) {
  for (const char* text : {"3.4028236e38", "1e39", "-1e39", "1e400", "1e99999999999999999999",
                           "340282360000000000000000000000000000000"}) {
    const auto parsed = parse_float(text);
    ASSERT_FALSE(parsed.has_value()) << text;
    EXPECT_NE(parsed.error().message.find("range"), std::string::npos) << parsed.error().message;
  }
  EXPECT_FALSE(parse_float("1" + std::string(1000, '0')).has_value());
}

TEST(SceneNumber, ReadsWholeNumbersStrictly) {
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("+7"), 7);
  for (const char* text : {"", "1.0", "1e3", "9223372036854775808", "0x1", " 1", "+-1", "a"}) {
    EXPECT_FALSE(parse_integer(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace gridrt::scene_detail
