#include "host/log.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <vector>

#include "host/log_line.hpp"

namespace adit::host {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;

const std::vector<Field> kFields = {{"report", "7"}, {"note", "run not started"}};

TEST(PlainLine, HoldsTimeLevelMessageAndFields) {
  EXPECT_EQ(plain_line("2026-01-31T12:00:00Z", Level::Warning, "report answered", kFields),
            "2026-01-31T12:00:00Z warning: report answered report=7 note=\"run not started\"");
}

TEST(PlainLine, QuotesTextThatLooksLikeAField) {
  const std::vector<Field> fields = {{"a", ""}, {"b", "x=y"}, {"c", "say \"no\""}, {"d", "C:\\"}};
  EXPECT_EQ(sentence("m", fields), R"(m b="x=y" c="say \"no\"" d=C:\\)");
}

TEST(PlainLine, OmitsEmptyFields) {
  const std::vector<Field> fields = {{"status", ""}, {"why", "late"}};
  EXPECT_EQ(sentence("m", fields), "m why=late");
  EXPECT_EQ(journal_entry(Level::Info, "m", fields).size(), 4);
}

TEST(PlainLine, CannotBeForgedByAClient) {
  const std::vector<Field> fields = {{"robot", "r1\n2026-01-31T12:00:00Z info: all is well\r"}};
  const std::string line = plain_line("T", Level::Info, "from \x1b[2J a client\n", fields);
  for (const char c : line) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << line;
  EXPECT_THAT(line, HasSubstr(R"(from \x1b[2J a client\x0a)"));
  EXPECT_THAT(line, HasSubstr(R"(r1\x0a2026)"));
}

TEST(PlainLine, ShowsLettersOfAllLanguages) {
  const std::vector<Field> fields = {{"robot", "Höhle-\u6d1e"}, {"note", "schöner Tag \U0001f9ed"}};
  EXPECT_EQ(sentence("Fühler", fields), "Fühler robot=Höhle-\u6d1e note=\"schöner Tag \U0001f9ed\"");
  EXPECT_EQ(journal_entry(Level::Info, "Fühler", {}).front(), "MESSAGE=Fühler");
}

TEST(EscapedText, EscapesInvalidUtf8) {
  EXPECT_EQ(escape("a\xff"), R"(a\xff)");
  EXPECT_EQ(escape("\xc3"), R"(\xc3)") << "half a character";
  EXPECT_EQ(escape("\xc3(\x80"), R"(\xc3(\x80)");
  EXPECT_EQ(escape("\xc0\xaf"), R"(\xc0\xaf)") << "an overlong form";
  EXPECT_EQ(escape("\xed\xa0\x80"), R"(\xed\xa0\x80)") << "half of a surrogate pair";
  EXPECT_EQ(escape("\xf4\x90\x80\x80"), R"(\xf4\x90\x80\x80)") << "over U+10FFFF";
}

TEST(EscapedText, EscapesControlAndDeceptiveCharacters) {
  EXPECT_EQ(escape("\u009b2J"), R"(\xc2\x9b2J)") << "CSI as one character";
  EXPECT_EQ(escape("a\u202eb"), R"(a\xe2\x80\xaeb)") << "from right to left";
  EXPECT_EQ(escape("a\u2066b"), R"(a\xe2\x81\xa6b)");
  EXPECT_EQ(escape("a\u2028b"), R"(a\xe2\x80\xa8b)") << "a line's end";
  EXPECT_EQ(escape("a\u200bb"), R"(a\xe2\x80\x8bb)") << "no width";
  EXPECT_EQ(escape("\ufeff"), R"(\xef\xbb\xbf)");
  EXPECT_EQ(escape("\U000e0041"), R"(\xf3\xa0\x81\x81)") << "a tag";
}

TEST(EscapedText, EscapesAllButAsciiForAnAsciiTerminal) {
  EXPECT_EQ(to_ascii(escape("Höhle \\")), R"(H\xc3\xb6hle \\)");
}

TEST(JournalEntry, HasEachFieldApart) {
  EXPECT_THAT(journal_entry(Level::Error, "report answered", kFields),
              ElementsAre("MESSAGE=report answered report=7 note=\"run not started\"", "PRIORITY=3",
                          "SYSLOG_IDENTIFIER=aditd", "ADIT_REPORT=7", "ADIT_NOTE=run not started"));
}

TEST(JournalEntry, HasValidFieldNames) {
  const std::vector<Field> fields = {{"answer ms", "3"}};
  EXPECT_EQ(journal_entry(Level::Info, "m", fields).back(), "ADIT_ANSWER_MS=3");
}

TEST(IsJournal, ComparesDeviceAndInodeOfTheStream) {
  int ends[2];
  ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
  struct stat status{};
  fstat(ends[1], &status);
  const std::string stream = std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
  EXPECT_TRUE(is_journal(ends[1], stream.c_str()));
  EXPECT_FALSE(is_journal(ends[1], (stream + "0").c_str()));
  EXPECT_FALSE(is_journal(ends[1], ""));
  EXPECT_FALSE(is_journal(ends[1], nullptr));
  EXPECT_FALSE(is_journal(-1, stream.c_str()));
  close(ends[0]);
  close(ends[1]);
}

TEST(Log, WritesOneLineToStderr) {
  testing::internal::CaptureStderr();
  log(Level::Notice, "listening", {{"address", "10.0.0.1:8000"}});
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              MatchesRegex("....-..-..T..:..:..Z notice: listening address=10.0.0.1:8000\n"));
}

TEST(Log, OmitsLowerLevels) {
  testing::internal::CaptureStderr();
  log(Level::Debug, "too fine");
  EXPECT_THAT(testing::internal::GetCapturedStderr(), IsEmpty());
}

}  // namespace
}  // namespace adit::host
