#include "api/ustar.hpp"

#include <gmock/gmock.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace adit::api {
namespace {

/// A folder, for a test's time.
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

/// What tar itself makes of an archive, in `folder`.
int unpack(const Folder& folder, const icd::ChunkedBytes& archive) {
  const std::string bytes = archive.to_string();
  std::ofstream(folder.path / "a.tar", std::ios::binary) << bytes;
  return std::system(("tar -C " + folder.path.string() + " -xf " + (folder.path / "a.tar").string() + " 2> " +
                      (folder.path / "said").string())
                         .c_str());
}

TEST(Ustar, IsReadByTar) {
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

TEST(Ustar, HoldsNothingButItsEndWithoutFiles) {
  const Folder folder;
  EXPECT_EQ(Ustar{}.finish().to_string(), std::string(1024, '\0'));
  EXPECT_EQ(unpack(folder, Ustar{}.finish()), 0);
}

TEST(Ustar, CutsANameThatIsTooLongForTheFormat) {
  const Folder folder;
  Ustar archive;
  archive.add(std::string(150, 'n'), "text", -5);
  ASSERT_EQ(unpack(folder, archive.finish()), 0) << read(folder.path / "said");
  EXPECT_EQ(read(folder.path / std::string(100, 'n')), "text");
}

}  // namespace
}  // namespace adit::api
