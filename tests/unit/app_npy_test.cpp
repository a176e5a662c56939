#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "host/app/npy.hpp"

namespace gridrt {
namespace {

namespace fs = std::filesystem;

class Npy : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = fs::temp_directory_path() /
            ("gridrt-npy-" + std::string(info->name()) + "-" + std::to_string(::getpid()));
  }
  void TearDown() override { fs::remove(path_); }

  void save(const std::string& header, const std::vector<double>& values) const {
    std::ofstream out(path_, std::ios::binary);
    out << header;
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(double)));
  }
  // The error of opening the file and reading all its rows.
  [[nodiscard]] Error failure() const {
    auto reader = NpyRayReader::open(path_);
    if (!reader) return reader.error();
    std::vector<Ray> rays(reader->count());
    auto read = reader->read(rays);
    EXPECT_FALSE(read.has_value());
    return read ? Error{} : read.error();
  }

  fs::path path_;
};

std::string f8_header(const std::string& shape) { return npy_header("'<f8'", shape); }

TEST(NpyHeaderText, IsAsNumpyWritesIt) {
  const std::string header = npy_header("'<f8'", "(3, 6)");
  EXPECT_EQ(header.size(), 128U);
  EXPECT_EQ(header.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  EXPECT_EQ(static_cast<unsigned char>(header[8]), 118U);
  EXPECT_EQ(header.substr(10, 59), "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 6), }");
  EXPECT_EQ(header.back(), '\n');
}

TEST(NpyDictionary, ReadsWhatPythonMayWrite) {
  const auto header =
      parse_npy_dictionary("{ \"shape\":(2,8,),'fortran_order' : True,'descr':'<f8'}  \n").value();
  EXPECT_EQ(header.descr, "<f8");
  EXPECT_TRUE(header.fortran_order);
  EXPECT_EQ(header.shape, (std::vector<std::uint64_t>{2, 8}));
  const auto structured = parse_npy_dictionary(
      "{'descr': [('a', '<i4'), ('b', '<f8', (2,))], 'fortran_order': False, 'shape': (5,), }");
  EXPECT_TRUE(structured.value().descr.empty());
  EXPECT_TRUE(parse_npy_dictionary("{'descr':'<f8','fortran_order':False,'shape':()}").has_value());
}

TEST(NpyDictionary, RefusesWhatIsDamaged) {
  for (const char* text :
       {"", "{", "{}", "{'descr': '<f8', 'fortran_order': False}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 6), } x",
        "{'descr': '<f8, 'fortran_order': False, 'shape': (1, 6), }",
        "{'descr': '<f8', 'fortran_order': Maybe, 'shape': (1, 6), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-1, 6), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1 6), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999, 6), }",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (1, 6), }",
        "{'descr': [('a', '<f8'), 'fortran_order': False, 'shape': (1, 6), }",
        "{'other': '<f8', 'fortran_order': False, 'shape': (1, 6), }"}) {
    EXPECT_FALSE(parse_npy_dictionary(text).has_value()) << text;
  }
}

TEST_F(Npy, ReadsSixColumnsWithDefaultsInPieces) {
  save(f8_header("(3, 6)"), {1, 2, 3, 4, 5, 6, 0, 0, 0, 0, 0, 1, -1, -2, -3, -4, -5, -6});
  auto reader = NpyRayReader::open(path_).value();
  ASSERT_EQ(reader.count(), 3U);
  std::vector<Ray> rays(3);
  ASSERT_TRUE(reader.read(std::span(rays).first(2)).has_value());
  ASSERT_TRUE(reader.read(std::span(rays).last(1)).has_value());
  EXPECT_EQ(rays[0].origin, glm::dvec3(1, 2, 3));
  EXPECT_EQ(rays[0].direction, glm::dvec3(4, 5, 6));
  EXPECT_EQ(rays[0].tmin, 0.0);
  EXPECT_EQ(rays[0].tmax, std::numeric_limits<double>::infinity());
  EXPECT_EQ(rays[2].direction, glm::dvec3(-4, -5, -6));
}

TEST_F(Npy, ReadsEightColumnsAndLaterVersions) {
  const std::string dictionary = "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 8), }\n";
  for (const char version : {'\x02', '\x03'}) {
    std::string header("\x93NUMPY", 6);
    header += version;
    header += std::string("\0", 1);
    header += static_cast<char>(dictionary.size());
    header += std::string("\0\0\0", 3) + dictionary;
    save(header, {1, 2, 3, 4, 5, 6, 0.25, 8});
    auto reader = NpyRayReader::open(path_).value();
    std::vector<Ray> rays(1);
    ASSERT_TRUE(reader.read(rays).has_value());
    EXPECT_EQ(rays[0].tmin, 0.25);
    EXPECT_EQ(rays[0].tmax, 8.0);
  }
}

TEST_F(Npy, NoRowsAreFine) {
  save(f8_header("(0, 6)"), {});
  auto reader = NpyRayReader::open(path_).value();
  EXPECT_EQ(reader.count(), 0U);
  EXPECT_TRUE(reader.read({}).has_value());
  save(f8_header("(0, 6)"), {1});
  EXPECT_NE(failure().message.find("goes on"), std::string::npos);
}

TEST_F(Npy, RefusesOtherArraysWithAdvice) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {npy_header("'<f4'", "(1, 6)"), "astype"},
      {npy_header("'>f8'", "(1, 6)"), "astype"},
      {npy_header("[('a', '<f8')]", "(1, 6)"), "astype"},
      {f8_header("(6,)"), "tmin"},
      {f8_header("(1, 7)"), "tmin"},
      {f8_header("(1, 6, 1)"), "tmin"},
  };
  for (const auto& [header, advice] : cases) {
    save(header, {0, 0, 0, 1, 0, 0, 0});
    const Error error = failure();
    EXPECT_EQ(error.kind, ErrorKind::kInput);
    EXPECT_NE(error.message.find(path_.string()), std::string::npos);
    EXPECT_NE(error.advice.find(advice), std::string::npos) << error.message;
  }
  std::string fortran = f8_header("(1, 6)");
  fortran.replace(fortran.find("False"), 5, "True ");
  save(fortran, {0, 0, 0, 1, 0, 0});
  EXPECT_NE(failure().advice.find("ascontiguousarray"), std::string::npos);
}

TEST_F(Npy, RefusesDamagedFiles) {
  const std::string good = f8_header("(2, 6)");
  const std::vector<double> row = {0, 0, 0, 1, 0, 0};
  save(good, row);
  EXPECT_NE(failure().message.find("ends within row 1"), std::string::npos);
  save(good.substr(0, 60), {});
  EXPECT_NE(failure().message.find("header"), std::string::npos);
  save(good.substr(0, 9), {});
  EXPECT_NE(failure().message.find("header"), std::string::npos);
  save("PK\x03\x04", row);
  EXPECT_NE(failure().message.find("not an .npy"), std::string::npos);
  save("", {});
  EXPECT_NE(failure().message.find("not an .npy"), std::string::npos);
  save(std::string("\x93NUMPY\x04\x00", 8) + good.substr(8), row);
  EXPECT_NE(failure().message.find("version 4.0"), std::string::npos);
  save(std::string("\x93NUMPY\x02\x00\xff\xff\xff\xff", 12), row);
  EXPECT_NE(failure().message.find("absurd"), std::string::npos);
  save(f8_header("(3000000000000000000, 6)"), row);
  EXPECT_NE(failure().message.find("absurd"), std::string::npos);
  fs::remove(path_);
  EXPECT_EQ(NpyRayReader::open(path_).error().kind, ErrorKind::kFile);
  EXPECT_EQ(NpyRayReader::open(fs::temp_directory_path()).error().kind, ErrorKind::kFile);
}

TEST_F(Npy, NamesTheRowOfARayThatIsNone) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<std::vector<double>> bad = {
      {0, 0, 0, 0, 0, 0, 0, 1},  {0, NAN, 0, 1, 0, 0, 0, 1}, {0, 0, 0, kInfinity, 0, 0, 0, 1},
      {0, 0, 0, 1, 0, 0, -1, 1}, {0, 0, 0, 1, 0, 0, 2, 1},   {0, 0, 0, 1, 0, 0, 0, NAN}};
  for (const std::vector<double>& row : bad) {
    std::vector<double> rows = {0, 0, 0, 1, 0, 0, 0, kInfinity};
    rows.insert(rows.end(), row.begin(), row.end());
    save(f8_header("(2, 8)"), rows);
    const Error error = failure();
    EXPECT_EQ(error.kind, ErrorKind::kInput);
    EXPECT_NE(error.message.find("row 1"), std::string::npos) << error.message;
  }
}

TEST_F(Npy, HitsArePackedRows) {
  const std::vector<Hit> hits = {{7, 1.5, 0.25, 0.5}, {}};
  auto file = OutputFile::create(path_).value();
  ASSERT_TRUE(file.write(hits_header(2)).has_value());
  ASSERT_TRUE(write_hits(file, hits).has_value());
  ASSERT_TRUE(file.commit().has_value());
  std::ifstream in(path_, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const std::size_t header = hits_header(2).size();
  ASSERT_EQ(bytes.size(), header + 56);
  std::int32_t id = 0;
  double v = 0.0;
  std::memcpy(&id, bytes.data() + header, 4);
  std::memcpy(&v, bytes.data() + header + 20, 8);
  EXPECT_EQ(id, 7);
  EXPECT_EQ(v, 0.5);
  std::memcpy(&id, bytes.data() + header + 28, 4);
  EXPECT_EQ(id, -1);
}

}  // namespace
}  // namespace gridrt
