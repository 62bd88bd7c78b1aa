#include "api/bundle.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>

namespace adit::api {
namespace {

using testing::EndsWith;
using testing::StartsWith;

std::size_t size_of(const std::vector<BundleFile>& files) {
  return std::accumulate(files.begin(), files.end(), std::size_t{0},
                         [](std::size_t sum, const BundleFile& file) { return sum + file.body.size(); });
}

TEST(CutTo, KeepsFilesThatFit) {
  std::vector<BundleFile> files = {{"a", std::string(600, 'a')}, {"b", std::string(400, 'b')}};
  cut_to(files, 1000);
  EXPECT_EQ(files[0].body, std::string(600, 'a'));
  EXPECT_EQ(files[1].body, std::string(400, 'b'));
}

TEST(CutTo, CutsTheBeginningOfTheLargestFiles) {
  std::vector<BundleFile> files = {{"small", "all of it"},
                                   {"log", std::string(5000, 'l') + "the end"},
                                   {"reports", std::string(9000, 'r')}};
  cut_to(files, 2009);
  EXPECT_EQ(files[0].body, "all of it");
  EXPECT_THAT(files[1].body, StartsWith("[the first 40"));
  EXPECT_THAT(files[1].body, EndsWith("lthe end"));
  EXPECT_THAT(files[2].body, StartsWith("[the first 80"));
  EXPECT_LE(size_of(files), 2009);
  EXPECT_GT(size_of(files), 1950);
  const std::string& cut = files[2].body;
  const std::size_t left = cut.size() - cut.find('\n') - 1;
  EXPECT_THAT(cut, StartsWith("[the first " + std::to_string(9000 - left) + " of 9000 bytes are cut off"));
}

TEST(CutTo, SplitsNoCharacter) {
  std::string body;
  for (int i = 0; i < 1000; ++i) body += "\xe2\x82\xac";
  for (std::size_t most = 500; most < 506; ++most) {
    std::vector<BundleFile> files = {{"euros", body}};
    cut_to(files, most);
    const std::string rest = files[0].body.substr(files[0].body.find('\n') + 1);
    EXPECT_THAT(rest, StartsWith("\xe2\x82\xac")) << most;
    EXPECT_EQ(rest.size() % 3, 0) << most;
  }
}

TEST(Bundle, StaysWithinItsLimitIfNothingCanBePacked) {
  std::mt19937_64 random(1);
  std::string noise(70'000, '\0');  // longer than gzip's window
  for (char& byte : noise) byte = static_cast<char>(random());
  std::vector<BundleFile> files;
  for (const char* name : {"log.txt", "reports.json", "run.json"}) {
    std::string body;
    while (body.size() < 7'000'000) body += noise;
    files.push_back({name, std::move(body)});
  }
  const std::string bundle = write_bundle(std::move(files), "adit", 1'780'000'000);
  EXPECT_LE(bundle.size(), kMostBundle);
  EXPECT_GT(bundle.size(), kMostBundle - 100'000);
}

/// A temporary directory of one test.
struct Folder {
  Folder() {
    std::string name = testing::TempDir() + "ustar.XXXXXX";
    path = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

int unpack(const Folder& folder, const icd::ChunkedBytes& archive) {
  const std::string bytes = archive.to_string();
  std::ofstream(folder.path / "a.tar", std::ios::binary) << bytes;
  return std::system(("tar -C " + folder.path.string() + " -xf " + (folder.path / "a.tar").string() + " 2> " +
                      (folder.path / "said").string())
                         .c_str());
}

TEST(Ustar, IsReadableByTar) {
  const Folder folder;
  Ustar archive;
  archive.add("adit/run.json", "{\"now\":1}\n", 1'700'000'000);
  archive.add("adit/empty", "", 1'700'000'000);
  archive.add("adit/block", std::string(512, 'b'), 1'700'000'000);
  archive.add("adit/long", std::string(200'001, 'x'), 0);
  const auto bytes = archive.finish();
  EXPECT_EQ(bytes.size() % 512, 0);
  ASSERT_EQ(unpack(folder, bytes), 0) << read(folder.path / "said");
  EXPECT_EQ(read(folder.path / "said"), "");
  EXPECT_EQ(read(folder.path / "adit/run.json"), "{\"now\":1}\n");
  EXPECT_EQ(read(folder.path / "adit/empty"), "");
  EXPECT_EQ(read(folder.path / "adit/block"), std::string(512, 'b'));
  EXPECT_EQ(read(folder.path / "adit/long"), std::string(200'001, 'x'));
  EXPECT_EQ(std::filesystem::status(folder.path / "adit/run.json").permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST(Ustar, HasOnlyItsEndWithoutFiles) {
  const Folder folder;
  EXPECT_EQ(Ustar{}.finish().to_string(), std::string(1024, '\0'));
  EXPECT_EQ(unpack(folder, Ustar{}.finish()), 0);
}

TEST(Ustar, CutsALongName) {
  const Folder folder;
  Ustar archive;
  archive.add(std::string(150, 'n'), "text", -5);
  ASSERT_EQ(unpack(folder, archive.finish()), 0) << read(folder.path / "said");
  EXPECT_EQ(read(folder.path / std::string(100, 'n')), "text");
}

}  // namespace
}  // namespace adit::api
