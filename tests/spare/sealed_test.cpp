#include "spare/sealed.hpp"

#include <gtest/gtest.h>

namespace adit::spare {
namespace {

constexpr std::string_view kCode = "1234567890123456";
const Seed kSeed{.salt = {1, 2, 3}, .nonce = {4, 5, 6}};

std::string sealed(std::string_view content) {
  auto file = seal(content, kCode, kSeed);
  EXPECT_TRUE(file) << file.error();
  return file.value_or("");
}

std::string why_not(std::string_view file, std::string_view code = kCode) {
  const auto content = unseal(file, code);
  return content ? "" : content.error();
}

TEST(SealedExport, IsOpenedOnlyByItsCode) {
  const std::string content("reports\0and tokens", 18), file = sealed(content);
  EXPECT_EQ(unseal(file, kCode), content);
  EXPECT_EQ(why_not(file, "1234567890123457"),
            "the code is not that of this export, or the export is damaged");
  EXPECT_EQ(file.find("tokens"), std::string::npos) << "the content is readable without the code";
}

TEST(SealedExport, MayBeEmpty) {
  EXPECT_EQ(unseal(sealed(""), kCode), "");
}

TEST(SealedExport, IsRejectedIfChangedOrTruncated) {
  const std::string file = sealed("a ledger");
  ASSERT_EQ(file.size(), 76U);
  // The first and the last byte of each part: type, salt, nonce, content and tag.
  for (const std::size_t at : {0, 9, 10, 11, 12, 27, 28, 51, 52, 59, 60, 68, 75}) {
    std::string changed = file;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    EXPECT_NE(why_not(changed), "") << "byte " << at;
    EXPECT_NE(why_not(file.substr(0, at)), "") << "cut off at byte " << at;
  }
  EXPECT_NE(why_not(file + "x"), "");
}

TEST(SealedExport, OfALaterAditIsRejectedByItsFirstBytes) {
  std::string file = sealed("a ledger");
  file[10] = 2;
  const char* const why =
      "a later Adit made this export (version 2, this box reads 1): update this box first";
  EXPECT_EQ(export_error(file.substr(0, kExportHead)), why);
  EXPECT_EQ(why_not(file), why);
}

TEST(SealedExport, OtherFilesAreRejectedByTheirFirstBytes) {
  EXPECT_EQ(export_error(sealed("a ledger").substr(0, kExportHead)), "");
  for (const std::string_view other : {"", "adit", "PK\3\4 a zip file", "adit-share\1"})
    EXPECT_EQ(export_error(other.substr(0, kExportHead)), "the file is not an export from Adit") << other;
}

TEST(Code, HasSixteenDigits) {
  std::array<std::uint8_t, kCodeDigits> random{};
  EXPECT_EQ(draw_code(random), "0000000000000000");
  random.fill(0xff);
  EXPECT_EQ(draw_code(random), "5541128671347064") << "2^128 - 1, from its last digit on";
}

TEST(Code, IsShownInGroupsAndReadInAnyGrouping) {
  EXPECT_EQ(code_text("1234567890123456"), "1234 5678 9012 3456");
  for (const char* const typed : {"1234567890123456", "1234 5678 9012 3456", "1234-5678-9012-3456 "})
    EXPECT_EQ(code_in(typed), "1234567890123456") << typed;
  for (const char* const wrong : {"", "123456789012345", "12345678901234567", "1234567890123x56", "１234"})
    EXPECT_FALSE(code_in(wrong)) << wrong;
}

}  // namespace
}  // namespace adit::spare
