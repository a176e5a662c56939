// .grt files: the same bytes back, no flipped bit unseen, nothing half-written.
#include "host/image/image_file.hpp"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image_support.hpp"

namespace gridrt {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed at the end.
class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gridrt_image_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    std::error_code ignored;
    fs::permissions(folder_, fs::perms::owner_all, ignored);
    fs::remove_all(folder_, ignored);
  }
  [[nodiscard]] std::size_t files() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  [[nodiscard]] const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

std::vector<std::byte> content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

void put(const fs::path& path, std::span<const std::byte> bytes) {
  std::ofstream file(path, std::ios::binary);
  for (const std::byte b : bytes) file.put(static_cast<char>(b));
}

TEST_F(ImageFile, SavesAndLoadsTheSameBytes) {
  for (const auto layout : {protocol::Layout::kWide, protocol::Layout::kCompact}) {
    ImageOptions options;
    options.layout = layout;
    const Image image = must_build(random_scene(100, 1), options);
    const fs::path path = folder() / "a.grt";
    const auto written = write_image(image, path);
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(files(), 1U);
    EXPECT_EQ(content(path), serialize_image(image));
    const auto read = read_image(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->header, image.header);
    ASSERT_TRUE(write_image(*read, folder() / "b.grt"));
    EXPECT_EQ(content(folder() / "b.grt"), content(path));
    EXPECT_TRUE(verify_image(*read));
    fs::remove(folder() / "b.grt");
  }
}

TEST_F(ImageFile, HeaderSectionStartsTheFile) {
  const Image image = must_build(random_scene(20, 2));
  const std::vector<std::byte> header = header_section(image);
  const std::vector<std::byte> all = serialize_image(image);
  EXPECT_EQ(header.size(), 144U + 16U * image.sections.size() + 4U);
  EXPECT_TRUE(std::equal(header.begin(), header.end(), all.begin()));
  EXPECT_EQ(all.size() % 4, 0U);
}

TEST(ParseImage, FindsEveryFlippedBit) {
  for (const auto layout : {protocol::Layout::kWide, protocol::Layout::kCompact}) {
    ImageOptions options;
    options.layout = layout;
    options.pes = 2;
    std::vector<std::byte> bytes = serialize_image(must_build(random_scene(8, 3), options));
    ASSERT_TRUE(parse_image(bytes, "small.grt"));
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      const auto mask = static_cast<std::byte>(1U << (bit % 8));
      bytes[bit / 8] ^= mask;
      const auto image = parse_image(bytes, "small.grt");
      ASSERT_FALSE(image) << "bit " << bit;
      EXPECT_EQ(image.error().kind, ErrorKind::kInput);
      EXPECT_TRUE(image.error().message.starts_with("small.grt: ")) << image.error().message;
      bytes[bit / 8] ^= mask;
    }
  }
}

TEST(ParseImage, FindsEveryTruncationAndAddedBytes) {
  std::vector<std::byte> bytes = serialize_image(must_build(random_scene(8, 3)));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_FALSE(parse_image(std::span(bytes).first(size), "short.grt")) << size;
  }
  for (int i = 0; i < 5; ++i) {
    bytes.push_back(std::byte{0});
    EXPECT_FALSE(parse_image(bytes, "long.grt"));
  }
}

TEST_F(ImageFile, ErrorsNameFileAndReason) {
  const auto missing = read_image(folder() / "none.grt");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::kFile);
  EXPECT_NE(missing.error().message.find("none.grt"), std::string::npos);
  EXPECT_NE(missing.error().message.find("No such file"), std::string::npos);
  const auto directory = read_image(folder());
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().kind, ErrorKind::kFile);
  const fs::path junk = folder() / "junk.grt";
  put(junk, std::vector(1000, std::byte{'x'}));
  const auto not_ours = read_image(junk);
  ASSERT_FALSE(not_ours);
  EXPECT_EQ(not_ours.error().kind, ErrorKind::kInput);
  EXPECT_NE(not_ours.error().message.find("not a .grt file"), std::string::npos);
  put(junk, {});
  EXPECT_FALSE(read_image(junk));
  std::vector<std::byte> damaged = serialize_image(must_build(random_scene(8, 3)));
  damaged.back() ^= std::byte{1};
  put(junk, damaged);
  const auto bad = read_image(junk);
  ASSERT_FALSE(bad);
  EXPECT_NE(bad.error().message.find("section Scene"), std::string::npos) << bad.error().message;
}

/// Writes while no file may grow beyond `bytes`, as on a full disk.
Result<void> write_with_limit(const Image& image, const fs::path& path, std::size_t bytes) {
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit old_limit{};
  EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  rlimit limit = old_limit;
  limit.rlim_cur = bytes;
  EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  auto written = write_image(image, path);
  EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &old_limit), 0);
  std::signal(SIGXFSZ, old_handler);
  return written;
}

TEST_F(ImageFile, FailedWritesLeaveTheOldFileAndNothingElse) {
  const fs::path path = folder() / "a.grt";
  const Image small = must_build(random_scene(8, 3));
  ASSERT_TRUE(write_image(small, path));
  const std::vector<std::byte> before = content(path);
  ImageOptions options;
  options.with_scene = false;
  const Image large = must_build(random_scene(400, 4), options);
  const std::size_t size = serialize_image(large).size();
  for (const std::size_t limit : {std::size_t{0}, std::size_t{100}, size / 2, size - 4}) {
    const auto written = write_with_limit(large, path, limit);
    ASSERT_FALSE(written) << limit << " of " << size;
    EXPECT_EQ(written.error().kind, ErrorKind::kFile);
    EXPECT_NE(written.error().message.find("a.grt"), std::string::npos);
    EXPECT_EQ(content(path), before);
    EXPECT_EQ(files(), 1U);
  }
  EXPECT_FALSE(write_image(small, folder() / "no" / "such" / "a.grt"));
  const auto directory = write_image(small, folder());
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().kind, ErrorKind::kFile);
  EXPECT_EQ(files(), 1U);
  ASSERT_TRUE(write_with_limit(large, path, size));
  EXPECT_EQ(content(path), serialize_image(large));
}

TEST_F(ImageFile, NewFilesHaveTheUsualMode) {
  const fs::path path = folder() / "a.grt";
  const mode_t old_mask = ::umask(027);
  const auto written = write_image(must_build(random_scene(8, 3)), path);
  ::umask(old_mask);
  ASSERT_TRUE(written);
  EXPECT_EQ(static_cast<unsigned>(fs::status(path).permissions()), 0640U);
}

TEST_F(ImageFile, ASymbolicLinkIsFollowedAndStays) {
  const fs::path target = folder() / "target.grt";
  const fs::path link = folder() / "link.grt";
  fs::create_symlink("target.grt", link);
  const Image image = must_build(random_scene(8, 3));
  ASSERT_TRUE(write_image(image, link));
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_EQ(content(target), serialize_image(image));
}

TEST_F(ImageFile, APipeIsWrittenToAndNotReplaced) {
  const fs::path pipe = folder() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const Image image = must_build(random_scene(8, 3));
  std::vector<std::byte> received;
  std::thread reader([&] { received = content(pipe); });
  const auto written = write_image(image, pipe);
  reader.join();
  ASSERT_TRUE(written) << written.error().message;
  EXPECT_EQ(received, serialize_image(image));
  EXPECT_TRUE(fs::is_fifo(pipe));
}

TEST(DescribeImage, ShowsEveryPe) {
  ImageOptions options;
  options.pes = 3;
  const std::string text = describe_image(must_build(random_scene(100, 5), options));
  for (const char* part :
       {"layout      Wide", "17 bits", "100, of which 14 degenerate", "PEs         3", "boxes",
        "balance", "occupied", "copies", "section     Vertices     2", "total"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
}

}  // namespace
}  // namespace gridrt
