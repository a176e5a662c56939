#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include <ImfArray.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include "host/image/output_file.hpp"
#include "host/render/picture.hpp"

namespace gridrt {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("gridrt-files-" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + "-" +
               std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string read(const fs::path& path) const {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(fs::directory_iterator(folder_), {});
  }
  static Result<void> write(const fs::path& path, std::string_view text) {
    return write_file(path, std::as_bytes(std::span(text)));
  }

  fs::path folder_;
};

Film small_film() {
  Film film{3, 2, {}};
  for (int i = 0; i < 6; ++i) {
    const auto x = static_cast<float>(i);
    film.pixels.emplace_back(0.1F * x, 0.5F, -1.0F + x);
  }
  return film;
}

TEST(Srgb, CodesOfTheTransferFunction) {
  EXPECT_EQ(srgb_code(0.0F), 0);
  EXPECT_EQ(srgb_code(1.0F), 255);
  EXPECT_EQ(srgb_code(0.5F), 188);        // (1.055 0.5^(1/2.4) - 0.055) 255 = 187.5157
  EXPECT_EQ(srgb_code(0.2158605F), 128);  // ((128 / 255 + 0.055) / 1.055)^2.4
  EXPECT_EQ(srgb_code(0.001F), 3);        // 12.92 x 0.001 x 255 = 3.29
  EXPECT_EQ(srgb_code(-4.0F), 0);
  EXPECT_EQ(srgb_code(7.0F), 255);
  EXPECT_EQ(srgb_code(std::numeric_limits<float>::infinity()), 255);
  EXPECT_EQ(srgb_code(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(Pictures, EndingsNameTheFormat) {
  EXPECT_EQ(picture_format("a/b.png").value(), PictureFormat::kPng);
  EXPECT_EQ(picture_format("b.EXR").value(), PictureFormat::kExr);
  EXPECT_EQ(picture_format("b.c.pfm").value(), PictureFormat::kPfm);
  for (const char* name : {"b", "b.jpg", "png", "/dev/full"}) {
    EXPECT_EQ(picture_format(name).error().kind, ErrorKind::kUsage) << name;
  }
}

TEST(Pictures, PfmHoldsFloatsFromTheBottomUp) {
  const Film film = small_film();
  const auto bytes = encode_picture(film, PictureFormat::kPfm).value();
  const std::string header = "PF\n3 2\n-1.0\n";
  ASSERT_EQ(bytes.size(), header.size() + (6 * 12));
  EXPECT_EQ(std::memcmp(bytes.data(), header.data(), header.size()), 0);
  EXPECT_EQ(std::memcmp(bytes.data() + header.size(), &film.pixels[3], 36), 0);
  EXPECT_EQ(std::memcmp(bytes.data() + header.size() + 36, film.pixels.data(), 36), 0);
}

TEST(Pictures, PngHoldsSrgbCodesFromTheTopDown) {
  const Film film = small_film();
  const auto bytes = encode_picture(film, PictureFormat::kPng).value();
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0);
  EXPECT_EQ(image.width, 3U);
  EXPECT_EQ(image.height, 2U);
  image.format = PNG_FORMAT_RGB;
  std::vector<png_byte> codes(18);
  ASSERT_NE(png_image_finish_read(&image, nullptr, codes.data(), 0, nullptr), 0);
  for (std::size_t i = 0; i < 6; ++i) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(codes[(3 * i) + static_cast<std::size_t>(c)], srgb_code(film.pixels[i][c]));
    }
  }
}

TEST_F(Files, ExrHoldsLinearFloats) {
  const Film film = small_film();
  const auto bytes = encode_picture(film, PictureFormat::kExr).value();
  const fs::path path = folder_ / "a.exr";
  ASSERT_TRUE(write_file(path, bytes).has_value());
  Imf::InputFile file(path.c_str());
  EXPECT_EQ(file.header().dataWindow().max.x, 2);
  EXPECT_EQ(file.header().dataWindow().max.y, 1);
  std::vector<float> green(6);
  std::vector<float> blue(6);
  Imf::FrameBuffer frame;
  const std::size_t row = 3 * sizeof(float);
  frame.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(green.data()), 4, row));
  frame.insert("B", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(blue.data()), 4, row));
  file.setFrameBuffer(frame);
  file.readPixels(0, 1);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(green[i], film.pixels[i].y);
    EXPECT_EQ(blue[i], film.pixels[i].z);
  }
}

TEST_F(Files, AppearWholeAndReplaceWhatWasThere) {
  const fs::path path = folder_ / "out";
  ASSERT_TRUE(write(path, "first").has_value());
  ::chmod(path.c_str(), 0640);
  auto file = OutputFile::create(path).value();
  ASSERT_TRUE(file.write("second").has_value());
  EXPECT_EQ(read(path), "first");
  ASSERT_TRUE(file.commit().has_value());
  EXPECT_EQ(read(path), "second");
  EXPECT_EQ(fs::status(path).permissions(), fs::perms{0640});
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, LeaveNothingWhenAbandoned) {
  {
    auto file = OutputFile::create(folder_ / "out").value();
    ASSERT_TRUE(file.write("half").has_value());
    OutputFile moved = std::move(file);
    ASSERT_TRUE(moved.write("more").has_value());
  }
  EXPECT_EQ(entries(), 0);
}

TEST_F(Files, LeaveNothingWhenTheyCannotBePutInPlace) {
  const fs::path path = folder_ / "out";
  auto file = OutputFile::create(path).value();
  ASSERT_TRUE(file.write("text").has_value());
  fs::create_directory(path);
  const auto result = file.commit();
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().kind, ErrorKind::kFile);
  EXPECT_EQ(entries(), 1);
}

TEST_F(Files, FollowSymbolicLinks) {
  fs::create_symlink("target", folder_ / "link");
  ASSERT_TRUE(write(folder_ / "link", "text").has_value());
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(read(folder_ / "target"), "text");
  EXPECT_EQ(entries(), 2);
}

TEST_F(Files, AFullDiskIsAnErrorThatLeavesTheDeviceAlone) {
  fs::create_symlink("/dev/full", folder_ / "full");
  const auto result = write(folder_ / "full", "text");
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().kind, ErrorKind::kFile);
  EXPECT_NE(result.error().message.find("No space left"), std::string::npos);
  EXPECT_NE(result.error().message.find("full"), std::string::npos);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(Files, PlacesThatCannotBeWrittenAreErrors) {
  for (const fs::path& path : {folder_ / "none" / "out", folder_, fs::path("/proc/out"),
                               folder_ / std::string(300, 'x')}) {
    const auto result = OutputFile::create(path);
    ASSERT_FALSE(result.has_value()) << path;
    EXPECT_EQ(result.error().kind, ErrorKind::kFile);
    EXPECT_NE(result.error().message.find(path.string()), std::string::npos);
  }
  EXPECT_EQ(entries(), 0);
}

}  // namespace
}  // namespace gridrt
