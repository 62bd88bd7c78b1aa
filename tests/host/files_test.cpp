#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

using testing::HasSubstr;

TEST(ReadFile, GivesTheText) {
  const Folder folder;
  EXPECT_EQ(read_file(folder.put("a", std::string("x\0y\n", 4))).value(), std::string("x\0y\n", 4));
  EXPECT_EQ(read_file(folder.put("empty", "")).value(), "");
}

TEST(ReadFile, NamesTheFileAndTheReason) {
  const Folder folder;
  EXPECT_EQ(read_file(folder / "none").error(), (folder / "none") + ": No such file or directory");
  EXPECT_EQ(read_file(folder.path()).error(), folder.path() + ": is not a regular file");
}

TEST(ReadFile, LimitsTheSizeToOneMebibyte) {
  const Folder folder;
  EXPECT_TRUE(read_file(folder.put("most", std::string(1u << 20, 'x'))).has_value());
  EXPECT_THAT(read_file(folder.put("more", std::string((1u << 20) + 1, 'x'))).error(),
              HasSubstr("too large"));
}

TEST(MayExist, IsFalseOnlyIfTheFileIsCertainlyAbsent) {
  const Folder folder;
  EXPECT_FALSE(can_exist(folder / "none"));
  EXPECT_FALSE(can_exist(folder / "none/none"));
  EXPECT_TRUE(can_exist(folder.put("empty", "")));
  EXPECT_TRUE(can_exist(folder.path()));
  ASSERT_EQ(symlink("round", (folder / "round").c_str()), 0);
  EXPECT_TRUE(can_exist(folder / "round")) << "an unreadable directory may contain the file";
}

TEST(WriteFile, CreatesAFileOfTheGivenMode) {
  const Folder folder;
  ASSERT_TRUE(write_file(folder / "new", "text", 0640).has_value());
  EXPECT_EQ(read_file(folder / "new").value(), "text");
  struct stat status{};
  stat((folder / "new").c_str(), &status);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
}

TEST(WriteKept, ReadsBackTheSameAndDetectsFlippedBits) {
  const Folder folder;
  const std::string text = "{\"port\":8000}\n";
  ASSERT_TRUE(write_kept(folder / "kept", text));
  EXPECT_EQ(read_file(folder / "kept").value(), text);
  std::ifstream file(folder / "kept", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(bytes, text + "crc32 4f177a42\n");
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    folder.put("kept", flipped);
    EXPECT_EQ(read_file(folder / "kept").value(), flipped)
        << bit << ": whoever parses it finds the last line";
  }
  EXPECT_EQ(read_file(folder.put("edited", text)).value(), text) << "by a person";
}

TEST(ParseKept, TakesTheCopyOfADamagedFileAlone) {
  const Folder folder;
  const auto parse = [](std::string_view text) -> std::expected<int, std::string> {
    if (text == "1" || text == "2") return text[0] - '0';
    return std::unexpected("expected 1 or 2, got " + std::string(text));
  };
  const auto read = [&] { return parse_kept(folder / "kept", parse).value(); };
  ASSERT_TRUE(write_kept(folder / "kept", "1"));
  folder.put("kept", "");
  EXPECT_EQ(read(), 1);
  keep_copy(folder / "kept");
  EXPECT_EQ(read(), 1) << "a file without a checksum may be damaged, so it is not copied";
  folder.put("kept", "2");
  EXPECT_EQ(read(), 2) << "by a person";
  folder.put("kept", "5");
  folder.put("kept.copy", "6");
  EXPECT_EQ(read().error(), "expected 1 or 2, got 5");
  std::filesystem::remove(folder / "kept.copy");
  folder.put("kept", "2");
  keep_copy(folder / "kept");
  folder.put("kept", "");
  EXPECT_EQ(read(), 2) << "by an earlier version";
  ASSERT_TRUE(remove_file(folder / "kept"));
  EXPECT_FALSE(can_exist(folder / "kept.copy"));
  folder.put("kept", "5");
  std::filesystem::create_directory(folder / "kept.copy");
  EXPECT_THAT(parse_kept(folder / "kept", parse).error(), HasSubstr("not a regular file")) << "not damaged";
  std::filesystem::remove(folder / "kept");
  EXPECT_THAT(parse_kept(folder / "kept", parse).error(), HasSubstr("No such file"));
}

TEST(WriteFile, ReplacesTheFileAtomically) {
  const Folder folder;
  folder.put("settings", "old");
  std::ifstream reader(folder / "settings");
  ASSERT_TRUE(write_file(folder / "settings", "new", 0600).has_value());
  std::string seen;
  reader >> seen;
  EXPECT_EQ(seen, "old") << "an open reader keeps the complete old file";
  EXPECT_EQ(read_file(folder / "settings").value(), "new");
}

TEST(WriteFile, LeavesNothingIfItFails) {
  const Folder folder;
  std::filesystem::create_directory(folder / "taken");
  const auto written = write_file(folder / "taken", "text", 0600);
  ASSERT_FALSE(written.has_value());
  EXPECT_THAT(written.error(), HasSubstr(folder / "taken"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(WriteFile, RemovesTheRestOfAnInterruptedWrite) {
  const Folder folder;
  folder.put("settings.json", "old");
  folder.put("settings.json.writing", "the beginning of a text that is longer than the n");
  ASSERT_TRUE(write_file(folder / "settings.json", "new", kOursAlone).has_value());
  EXPECT_EQ(read_file(folder / "settings.json"), "new");
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"settings.json"});
  folder.put("access.json.writing", "half");
  remove_unwritten(folder.path());
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"settings.json"});
  remove_unwritten(folder / "none");
}

TEST(WriteFile, LeavesAtMostOneTemporaryFileAfterCrashes) {
  const Folder folder;
  for (int i = 0; i < 20; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      while (true) (void)write_file(folder / "a", std::string(100'000, 'x'), kForAll);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  const auto names = names_in(folder.path());
  ASSERT_TRUE(names.has_value());
  EXPECT_LE(names->size(), 2u);
}

TEST(WriteFile, ReportsAMissingDirectory) {
  const Folder folder;
  EXPECT_EQ(write_file(folder / "no/file", "text", 0600).error(),
            (folder / "no/file") + ": No such file or directory");
}

}  // namespace
}  // namespace adit::host
