#include "rehearsal/robots/maps/map_file.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>

namespace adit::robots {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;

const std::string kPcdHeader =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\n"
    "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";
const std::string kPlyHeader =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 2\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "property uchar red\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string floats(std::initializer_list<float> values) {
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.begin(), bytes.size());
  return bytes;
}

float float_at(const Cloud& cloud, std::size_t at) {
  float value = 0;
  std::memcpy(&value, cloud.data.data() + at, sizeof value);
  return value;
}

struct Folder : testing::Test {
  Folder() : path_(fs::path(testing::TempDir()) / ("adit_robots_maps_" + std::to_string(getpid()))) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() override { fs::remove_all(path_); }
  fs::path write(const fs::path& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  fs::path path_;
};

TEST(Pgm, FlipsRowsAndMapsGreysToThreeValues) {
  const auto grid = parse_pgm("P5\n# CREATOR\n3 2\n255\n"s + "\x00\xfe\xcd"s + "\xff\x59\x5a"s, MapYaml{});
  ASSERT_TRUE(grid) << grid.error();
  EXPECT_EQ(grid->width, 3u);
  EXPECT_EQ(grid->height, 2u);
  EXPECT_EQ(grid->resolution, 0.05);
  EXPECT_EQ(grid->cells, (std::vector<std::uint8_t>{0, 100, kUnknown, 100, 0, kUnknown}));
}

TEST(Pgm, ObeysTheYaml) {
  const auto yaml = parse_map_yaml(
      "image: 'a.pgm'\nresolution: 0.1  # metres\norigin: [-1.5, 2, 1.0]\nnegate: 1\noccupied_thresh: 0.9\n"
      "free_thresh: 0.1\n");
  ASSERT_TRUE(yaml) << yaml.error();
  EXPECT_EQ(yaml->image, "a.pgm");
  const auto grid = parse_pgm("P5 3 1 100\n" + "\x00\x32\x64"s, *yaml);
  ASSERT_TRUE(grid) << grid.error();
  EXPECT_EQ(grid->cells, (std::vector<std::uint8_t>{0, kUnknown, 100}));
  EXPECT_EQ(grid->origin.position, (Vector3{-1.5, 2, 0}));
  EXPECT_EQ(grid->origin.orientation, rotation_of(1));
  EXPECT_EQ(grid->resolution, 0.1);
}

TEST(Pgm, NamesTheFault) {
  const std::pair<std::string, const char*> cases[] = {
      {"", "P5"},
      {"P2\n1 1\n255\n0", "P5"},
      {"P5\n0 1\n255\n", "width"},
      {"P5\n1 -1\n255\n", "height"},
      {"P5\n1 1\n65535\n\0\0"s, "largest grey"},
      {"P5\n4294967295 4294967295\n255\n", "width"},
      {"P5\n80 60\n255\n" + std::string(4799, 'x'), "80 x 60 = 4800 cells, got 4799"},
      {"P5\n1 1\n255", "got 0"},
      {"P5 # for ever", "width"},
  };
  for (const auto& [bytes, sentence] : cases) {
    const auto grid = parse_pgm(bytes, MapYaml{});
    ASSERT_FALSE(grid) << sentence;
    EXPECT_NE(grid.error().find(sentence), std::string::npos) << grid.error();
  }
}

TEST(MapYaml, NamesTheWrongKey) {
  const std::pair<const char*, const char*> cases[] = {
      {"origin: [0, 0, 0]\n", "resolution"},
      {"resolution: 0\norigin: [0, 0, 0]\n", "resolution"},
      {"resolution: inf\norigin: [0, 0, 0]\n", "resolution"},
      {"resolution: 0.1\n", "origin"},
      {"resolution: 0.1\norigin: [0, 0]\n", "origin"},
      {"resolution: 0.1\norigin: [0, 0, 0, 0]\n", "origin"},
      {"resolution: 0.1\norigin: [0, 0, nan]\n", "origin"},
      {"resolution: 0.1\norigin: [0, 0, 0]\nmode: raw\n", "mode"},
      {"resolution: 0.1\norigin: [0, 0, 0]\nfree_thresh: 0.9\n", "free_thresh"},
  };
  for (const auto& [text, key] : cases) {
    const auto yaml = parse_map_yaml(text);
    ASSERT_FALSE(yaml) << text;
    EXPECT_TRUE(yaml.error().starts_with(std::string(key) + ":")) << yaml.error();
  }
}

TEST(Pcd, ReadsBinaryPoints) {
  const auto cloud = parse_pcd(kPcdHeader + "DATA binary\n" + floats({1, 2, 3, 4, 5, 6, 7, 8}));
  ASSERT_TRUE(cloud) << cloud.error();
  EXPECT_EQ(cloud->point_step, 16u);
  ASSERT_EQ(cloud->fields.size(), 4u);
  EXPECT_EQ(cloud->fields[3], (CloudField{"intensity", 12, kFloat32, 1}));
  EXPECT_EQ(cloud->data.size(), 32u);
  EXPECT_EQ(float_at(*cloud, 16), 5);
  EXPECT_FALSE(cloud->origin);
}

TEST(Pcd, ReadsAsciiPointsOfEveryType) {
  const auto cloud = parse_pcd(
      "FIELDS x y z _ ring rgb\nSIZE 8 8 8 1 2 4\nTYPE F F F U U F\nCOUNT 1 1 1 3 1 1\nVIEWPOINT 1 2 3 0 0 0 "
      "1\n"
      "POINTS 2\nDATA ascii\r\n1 2 3 9 9 9 65535 4.2e-38\r\n-1e2 +2 3 0 0 0 7 0\r\n");
  ASSERT_TRUE(cloud) << cloud.error();
  EXPECT_EQ(cloud->point_step, 33u);
  EXPECT_EQ(cloud->fields[3], (CloudField{"ring", 27, 4, 1})) << "padding is no field, but keeps its place";
  EXPECT_EQ(cloud->data[27], 0xff);
  EXPECT_EQ(cloud->data[28], 0xff);
  double x = 0;
  std::memcpy(&x, cloud->data.data() + 33, sizeof x);
  EXPECT_EQ(x, -100);
  EXPECT_EQ(cloud->origin, (Placement{.position = {1, 2, 3}, .orientation = {0, 0, 1, 0}}));
}

TEST(Pcd, OmitsNonFinitePoints) {
  const auto cloud = parse_pcd(kPcdHeader + "DATA ascii\nnan nan nan 1\n1 2 3 nan\n");
  ASSERT_TRUE(cloud) << cloud.error();
  EXPECT_EQ(cloud->data.size(), 16u);
  EXPECT_EQ(float_at(*cloud, 0), 1);
}

TEST(Pcd, NamesTheFault) {
  const std::string good = kPcdHeader + "DATA binary\n" + floats({1, 2, 3, 4, 5, 6, 7, 8});
  ASSERT_TRUE(parse_pcd(good));
  const std::pair<std::string, const char*> cases[] = {
      {"", "no DATA line"},
      {std::string(100'000, '\n'), "no DATA line"},
      {replaced(good, "binary", "binary_compressed"), "expected ascii or binary, got 'binary_compressed'"},
      {replaced(good, "POINTS 2", "POINTS 3"), "expected 3 points of 16 bytes, got 32 bytes"},
      {replaced(good, "POINTS 2", "POINTS 4294967295"), "expected 4294967295 points"},
      {replaced(good, "POINTS 2", "POINTS -2"), "expected"},
      {replaced(good, "SIZE 4 4 4 4", "SIZE 4 4 4"), "as many entries"},
      {replaced(good, "SIZE 4 4 4 4", "SIZE 4 4 4 8000"), "field 'intensity'"},
      {replaced(good, "SIZE 4 4 4 4", "SIZE 4 4 8 4"), "all float32 or all float64"},
      {replaced(good, "COUNT 1 1 1 1", "COUNT 1 1 1 0"), "COUNT"},
      {replaced(good, "COUNT 1 1 1 1", "COUNT 2 1 1 1"), "single"},
      {replaced(good, "COUNT 1 1 1 1", "COUNT 1 1 1 4294967295"), "COUNT"},
      {replaced(good, "FIELDS x y z", "FIELDS x y y"), "field 'y' is given twice"},
      {replaced(good, "FIELDS x y z", "FIELDS a y z"), "no field 'x'"},
      {replaced(good, "VIEWPOINT 0", "VIEWPOINT inf"), "VIEWPOINT"},
      {kPcdHeader + "DATA ascii\n1 2 3 4\n", "expected 2 points, got 1"},
      {kPcdHeader + "DATA ascii\n1 2 3 4\n1 2 3\n", "line 13: expected 4 values, got 3"},
      {kPcdHeader + "DATA ascii\n1 2 3 4\n1 2 3 four\n", "line 13: wrong value of intensity: 'four'"},
  };
  for (const auto& [bytes, sentence] : cases) {
    const auto cloud = parse_pcd(bytes);
    ASSERT_FALSE(cloud) << sentence;
    EXPECT_NE(cloud.error().find(sentence), std::string::npos) << cloud.error();
  }
}

TEST(Ply, ReadsAsciiAndLittleEndianVertices) {
  const auto ascii = parse_ply(kPlyHeader + "1 2 3 255\n4 5 6 0\n");
  ASSERT_TRUE(ascii) << ascii.error();
  EXPECT_EQ(ascii->point_step, 13u);
  EXPECT_EQ(ascii->fields[3], (CloudField{"red", 12, 2, 1}));
  EXPECT_EQ(float_at(*ascii, 13), 4);
  EXPECT_EQ(ascii->data[12], 255);

  const auto binary = parse_ply(replaced(kPlyHeader, "ascii", "binary_little_endian") + floats({1, 2, 3}) +
                                "\xff" + floats({4, 5, 6}) + "\x00"s);
  ASSERT_TRUE(binary) << binary.error();
  EXPECT_EQ(binary->data, ascii->data);
}

TEST(Ply, NamesTheFault) {
  const std::string good = kPlyHeader + "1 2 3 255\n4 5 6 0\n";
  const std::pair<std::string, const char*> cases[] = {
      {"", "the first line is not 'ply'"},
      {"ply\n", "no end_header"},
      {"ply\nformat ascii 1.0\nend_header\n", "no element vertex"},
      {replaced(good, "ascii", "binary_big_endian"), "got 'binary_big_endian'"},
      {replaced(good, "element vertex 2", "element face 2"), "first element"},
      {replaced(good, "element vertex 2", "element vertex -2"), "element vertex"},
      {replaced(good, "element vertex 2", "element vertex 3"), "expected 3 points, got 2"},
      {replaced(good, "property uchar red", "property list uchar int red"), "property red"},
      {replaced(good, "property float z", "property int z"), "all float32 or all float64"},
      {replaced(good, "255", "256"), "wrong value of red: '256'"},
  };
  for (const auto& [bytes, sentence] : cases) {
    const auto cloud = parse_ply(bytes);
    ASSERT_FALSE(cloud) << sentence;
    EXPECT_NE(cloud.error().find(sentence), std::string::npos) << cloud.error();
  }
}

TEST(MapFiles, SurviveAnyDamage) {
  std::mt19937_64 random(7);
  const std::string seeds[] = {
      "P5\n4 4\n255\n" + std::string(16, '\xfe'), kPcdHeader + "DATA binary\n" + std::string(32, 'a'),
      kPcdHeader + "DATA ascii\n1 2 3 4\n5 6 7 8\n", kPlyHeader + "1 2 3 4\n5 6 7 8\n"};
  for (int round = 0; round < 4000; ++round) {
    std::string bytes = seeds[static_cast<std::size_t>(round) % std::size(seeds)];
    for (int change = 0; change < 3; ++change) bytes[random() % bytes.size()] = static_cast<char>(random());
    bytes.resize(bytes.size() - random() % 8);
    (void)parse_pgm(bytes, MapYaml{});
    for (const auto& cloud : {parse_pcd(bytes), parse_ply(bytes)}) {
      if (cloud) {
        ASSERT_EQ(cloud->data.size() % cloud->point_step, 0u);
      }
    }
  }
}

TEST_F(Folder, FindsMapsAtAnyDepthInOrder) {
  write("b/grid.pgm", "");
  write("a.ply", "");
  write("b/c/cloud.pcd", "");
  write("readme.md", "");
  const auto files = find_maps(path_);
  ASSERT_TRUE(files) << files.error();
  EXPECT_EQ(*files, (std::vector<fs::path>{path_ / "a.ply", path_ / "b/c/cloud.pcd", path_ / "b/grid.pgm"}));
  EXPECT_FALSE(find_maps(path_ / "nowhere"));
}

TEST_F(Folder, FindsTheYamlByNameOrByItsImage) {
  const fs::path own = write("own.pgm", "P5 1 1 255\n\xfe"), named = write("named.pgm", "P5 1 1 255\n\xfe"),
                 bare = write("bare.pgm", "P5 1 1 255\n\xfe");
  write("own.yaml", "image: elsewhere.pgm\nresolution: 0.5\norigin: [1, 2, 0]\n");
  write("map.yaml", "image: maps/named.pgm\nresolution: 0.25\norigin: [1, 2, 0]\n");
  const auto resolution = [](const fs::path& file) {
    return std::get<Grid>(load_map(file).value()).resolution;
  };
  EXPECT_EQ(resolution(own), 0.5);
  EXPECT_EQ(resolution(named), 0.25);
  EXPECT_EQ(resolution(bare), 0.05);
}

TEST_F(Folder, NamesAnUnloadableFile) {
  const fs::path broken = write("broken.pcd", "nothing"),
                 empty = write("empty.pcd", replaced(kPcdHeader, "POINTS 2", "POINTS 0") + "DATA ascii\n");
  EXPECT_TRUE(load_map(broken).error().starts_with(broken.string() + ": not a PCD file"));
  EXPECT_EQ(load_map(empty).error(), empty.string() + ": the file has no points");
  EXPECT_FALSE(load_map(path_ / "absent.ply"));
  write("bad.pgm", "P5 1 1 255\n\xfe");
  write("bad.yaml", "resolution: x\n");
  EXPECT_NE(load_map(path_ / "bad.pgm").error().find("bad.yaml: resolution"), std::string::npos);
}

TEST(RealMaps, MatchTheirReadme) {
  const char* const named = std::getenv("ADIT_MAPS");
  const fs::path folder = named == nullptr ? "" : named;
  if (!fs::exists(folder)) GTEST_SKIP() << "ADIT_MAPS names no folder of recorded maps";
  const auto grid = load_map(folder / "grids/ecn_batS.pgm");
  ASSERT_TRUE(grid) << grid.error();
  const Grid& building = std::get<Grid>(*grid);
  EXPECT_EQ(building.width, 1598u);
  EXPECT_EQ(building.height, 1787u);
  EXPECT_EQ(building.resolution, 0.02);
  EXPECT_EQ(building.origin.position, (Vector3{-6.064576, -10.118860, 0}));
  for (const std::uint8_t value : {std::uint8_t{0}, std::uint8_t{100}, kUnknown}) {
    EXPECT_GT(std::count(building.cells.begin(), building.cells.end(), value), 1000) << int{value};
  }
  const std::pair<const char*, std::size_t> clouds[] = {{"clouds/locus_reference_82_garage.pcd", 8112},
                                                        {"clouds/fast_gicp_251370668.pcd", 69088},
                                                        {"clouds/small_gicp_target.ply", 69088}};
  for (const auto& [name, points] : clouds) {
    const auto cloud = load_map(folder / name);
    ASSERT_TRUE(cloud) << cloud.error();
    EXPECT_EQ(std::get<Cloud>(*cloud).data.size(), points * 16) << name;
  }
  const auto files = find_maps(folder);
  ASSERT_TRUE(files);
  for (const fs::path& file : *files) EXPECT_TRUE(load_map(file)) << file;
}

}  // namespace
}  // namespace adit::robots
