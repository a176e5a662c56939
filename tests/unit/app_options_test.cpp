#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "host/app/exit_code.hpp"
#include "host/app/options.hpp"
#include "host/app/parse.hpp"

namespace gridrt {
namespace {

using Words = std::vector<const char*>;

Result<std::variant<HostOptions, PrintAndExit>> parse_host(Words words) {
  words.insert(words.begin(), "gridrt-host");
  return parse_host_options(static_cast<int>(words.size()), words.data());
}

Result<std::variant<ImageProgramOptions, PrintAndExit>> parse_image(Words words) {
  words.insert(words.begin(), "gridrt-image");
  return parse_image_options(static_cast<int>(words.size()), words.data());
}

HostOptions host(const Words& words) { return std::get<HostOptions>(parse_host(words).value()); }

TEST(Parse, Integers) {
  EXPECT_EQ(parse_integer("--n", "0", 0, 9).value(), 0);
  EXPECT_EQ(parse_integer("--n", "+9", 0, 9).value(), 9);
  for (const char* text :
       {"", "10", "-1", "1.0", "0x1", "1 ", " 1", "+-1", "99999999999999999999"}) {
    const auto result = parse_integer("--n", text, 0, 9);
    ASSERT_FALSE(result.has_value()) << text;
    EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
    EXPECT_EQ(result.error().message,
              "--n " + std::string(text) + ": expected a whole number from 0 to 9");
  }
}

TEST(Parse, Vectors) {
  EXPECT_EQ(parse_vector("--eye", "-1,2.5e-3,+4").value(), glm::dvec3(-1.0, 2.5e-3, 4.0));
  for (const char* text : {"", "1,2", "1,2,3,4", "1,,3", "1,2,nan", "inf,0,0", "1, 2,3", "1;2;3"}) {
    EXPECT_FALSE(parse_vector("--eye", text).has_value()) << text;
  }
}

TEST(Parse, SizesGridsPixelsBits) {
  EXPECT_EQ(parse_size("--size", "640x480").value(), glm::ivec2(640, 480));
  for (const char* text : {"640", "640x", "0x4", "65536x1", "65535x65535", "4X4", "4x4x4"}) {
    EXPECT_FALSE(parse_size("--size", text).has_value()) << text;
  }
  EXPECT_EQ(parse_grid("--grid", "1x2x300").value(), glm::ivec3(1, 2, 300));
  EXPECT_FALSE(parse_grid("--grid", "auto").value().has_value());
  EXPECT_FALSE(parse_grid("--grid", "0x2x3").has_value());
  EXPECT_EQ(parse_pixel("--explain", "0,7").value(), glm::ivec2(0, 7));
  EXPECT_FALSE(parse_pixel("--explain", "-1,7").has_value());
  EXPECT_EQ(parse_bits("--bits", "auto").value(), 17);
  EXPECT_EQ(parse_bits("--bits", "24").value(), 24);
  EXPECT_FALSE(parse_bits("--bits", "25").has_value());
  EXPECT_FALSE(parse_bits("--bits", "3").has_value());
}

TEST(HostOptionsTest, Defaults) {
  const HostOptions options = host({"scene.obj", "-o", "a.png"});
  EXPECT_EQ(options.scene, "scene.obj");
  EXPECT_EQ(options.picture, "a.png");
  EXPECT_EQ(options.device, "auto");
  EXPECT_EQ(options.size, glm::ivec2(640, 480));
  EXPECT_EQ(options.samples, 1);
  EXPECT_FALSE(options.cut.bits || options.cut.grid || options.cut.pes);
  EXPECT_TRUE(options.shades());
}

TEST(HostOptionsTest, EverythingTogether) {
  const HostOptions options =
      host({"s.obj",   "--device",  "usb:0001",  "--size",     "3x4",      "--eye",     "-1,0,0",
            "--look",  "0,-1,0",    "--up",      "0,0,1",      "--fov",    "30.5",      "--depth",
            "0",       "--samples", "16",        "--bits",     "12",       "--grid",    "4x5x6",
            "--pes",   "8",         "--hits",    "h.npy",      "--stats",  "s.json",    "--lattice",
            "l.npz",   "--explain", "2,3",       "--progress", "off",      "--threads", "3",
            "--batch", "100",       "--mapping", "voxel",      "--layout", "compact",   "--output",
            "p.exr"});
  EXPECT_EQ(options.device, "usb:0001");
  EXPECT_EQ(options.eye.value(), glm::dvec3(-1.0, 0.0, 0.0));
  EXPECT_EQ(options.look.value(), glm::dvec3(0.0, -1.0, 0.0));
  EXPECT_EQ(options.fov.value(), 30.5);
  EXPECT_EQ(options.depth, 0);
  EXPECT_EQ(options.samples, 16);
  EXPECT_EQ(options.cut.bits.value(), 12);
  EXPECT_EQ(options.cut.grid.value(), glm::ivec3(4, 5, 6));
  EXPECT_EQ(options.cut.pes.value(), 8);
  EXPECT_EQ(options.cut.mapping.value(), Mapping::kVoxel);
  EXPECT_EQ(options.cut.layout.value(), protocol::Layout::kCompact);
  EXPECT_EQ(options.explain.value(), glm::ivec2(2, 3));
  EXPECT_EQ(options.progress, ProgressMode::kOff);
  EXPECT_EQ(options.threads, 3);
  EXPECT_EQ(options.batch, 100U);
}

TEST(HostOptionsTest, LightIsComputedForAPictureOrForTheStatisticsAlone) {
  EXPECT_TRUE(host({"s.obj", "--stats", "s.json"}).shades());
  EXPECT_TRUE(host({"s.obj", "-o", "a.png", "--hits", "h.npy"}).shades());
  EXPECT_FALSE(host({"s.obj", "--hits", "h.npy", "--stats", "s.json"}).shades());
  EXPECT_FALSE(host({"s.obj", "--lattice", "l.npz"}).shades());
  EXPECT_FALSE(host({"s.obj", "--explain", "1,1"}).shades());
  EXPECT_FALSE(host({"s.obj", "--rays", "r.npy", "--stats", "s.json"}).shades());
}

TEST(HostOptionsTest, WrongOnesAreUsageErrorsThatNameTheOption) {
  const std::vector<std::pair<Words, std::string>> cases = {
      {{}, "no scene"},
      {{"s.obj"}, "nothing to make"},
      {{"s.obj", "t.obj", "-o", "a.png"}, "t.obj"},
      {{"s.obj", "--colour", "red"}, "--colour"},
      {{"s.obj", "-o"}, "-o"},
      {{"s.obj", "-o", "a.png", "--size", "big"}, "--size"},
      {{"s.obj", "-o", "a.png", "--pes", "65"}, "--pes"},
      {{"s.obj", "-o", "a.png", "--pes", "2", "--pes", "4"}, "--pes"},
      {{"s.obj", "-o", "a.png", "--bits", "17.5"}, "--bits"},
      {{"s.obj", "-o", "a.png", "--mapping", "random"}, "--mapping"},
      {{"s.obj", "-o", "a.png", "--layout", "tight"}, "--layout"},
      {{"s.obj", "-o", "a.png", "--fov", "180"}, "--fov"},
      {{"s.obj", "-o", "a.png", "--fov", "nan"}, "--fov"},
      {{"s.obj", "-o", "a.png", "--eye", "1,2"}, "--eye"},
      {{"s.obj", "-o", "a.png", "--samples", "0"}, "--samples"},
      {{"s.obj", "-o", "a.png", "--depth", "-1"}, "--depth"},
      {{"s.obj", "-o", "a.png", "--threads", "0"}, "--threads"},
      {{"s.obj", "-o", "a.png", "--batch", "0"}, "--batch"},
      {{"s.obj", "-o", "a.png", "--progress", "maybe"}, "--progress"},
      {{"s.obj", "-o", "a.png", "--rays", "r.npy"}, "-o"},
      {{"s.obj", "--rays", "r.npy"}, "nothing to make"},
      {{"s.obj", "--rays", "r.npy", "--hits", "h.npy", "--size", "4x4"}, "--size"},
      {{"s.obj", "--rays", "r.npy", "--hits", "h.npy", "--fov", "40"}, "--fov"},
      {{"s.obj", "-o", "a.png", "--hits", "h.npy", "--any-hit"}, "--any-hit"},
      {{"s.obj", "--stats", "a.json", "--any-hit"}, "--any-hit"},
      {{"s.obj", "-o", "a.png", "--hits", "a.png"}, "same file"},
      {{"s.obj", "-o", "a.png", "--size", "4x4", "--explain", "4,0"}, "--explain"},
  };
  for (const auto& [words, place] : cases) {
    const auto result = parse_host(words);
    ASSERT_FALSE(result.has_value()) << place;
    EXPECT_EQ(result.error().kind, ErrorKind::kUsage) << place;
    EXPECT_NE(result.error().message.find(place), std::string::npos) << result.error().message;
  }
}

TEST(HostOptionsTest, ExactModeIsNamedAndNotThere) {
  const auto result = parse_host({"s.obj", "-o", "a.png", "--exact"});
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().kind, ErrorKind::kUnsupported);
}

TEST(HostOptionsTest, HelpNamesEveryOptionScenesAndExitCodes) {
  const std::string help = std::get<PrintAndExit>(parse_host({"--help"}).value()).text;
  for (const char* word :
       {"--device",  "-o",         "--size",    "--eye",          "--look",    "--up",
        "--fov",     "--depth",    "--samples", "--bits",         "--grid",    "--pes",
        "--exact",   "--schedule", "--rays",    "--hits",         "--stats",   "--lattice",
        "--explain", "--progress", "--any-hit", "--list-devices", "--version", "--threads",
        "--batch",   "--mapping",  "--layout",  "builtin:",       "teapot",    "Exit codes",
        "Examples"}) {
    EXPECT_NE(help.find(word), std::string::npos) << word;
  }
}

TEST(ImageOptionsTest, ExactlyOneThingToDo) {
  const auto made = std::get<ImageProgramOptions>(
      parse_image({"s.obj", "-o", "s.grt", "--pes", "2", "--bits", "auto"}).value());
  EXPECT_EQ(made.scene, "s.obj");
  EXPECT_EQ(made.output, "s.grt");
  EXPECT_EQ(made.cut.pes.value(), 2);
  EXPECT_EQ(std::get<ImageProgramOptions>(parse_image({"--info", "s.grt"}).value()).info, "s.grt");
  const std::vector<Words> wrong = {{},
                                    {"s.obj"},
                                    {"-o", "s.grt"},
                                    {"--info", "a.grt", "--verify", "a.grt"},
                                    {"s.obj", "--info", "a.grt"},
                                    {"--info", "a.grt", "--pes", "2"},
                                    {"s.obj", "-o", "s.grt", "--pes", "0"}};
  for (const Words& words : wrong) {
    const auto result = parse_image(words);
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().kind, ErrorKind::kUsage);
  }
}

TEST(ExitCodes, EveryKindHasOne) {
  EXPECT_EQ(exit_code(ErrorKind::kUsage), 2);
  EXPECT_EQ(exit_code(ErrorKind::kInput), 3);
  EXPECT_EQ(exit_code(ErrorKind::kFile), 4);
  EXPECT_EQ(exit_code(ErrorKind::kLimit), 5);
  EXPECT_EQ(exit_code(ErrorKind::kUnsupported), 5);
  for (const ErrorKind kind :
       {ErrorKind::kDevice, ErrorKind::kTransport, ErrorKind::kTimeout, ErrorKind::kProtocol}) {
    EXPECT_EQ(exit_code(kind), 6);
  }
  EXPECT_EQ(exit_code(ErrorKind::kInternal), 70);
}

}  // namespace
}  // namespace gridrt
