#include "spare/content.hpp"

#include <gtest/gtest.h>

namespace adit::spare {
namespace {

Content content() {
  Content content;
  content.about = {.box = "0123456789abcdef",
                   .name = "10.0.0.1:80",
                   .version = "1.2.3",
                   .at = 1.75e9,
                   .stamps = 1.75e9 + 30,
                   .reports = 4,
                   .open = 1,
                   .post = "10.100.1.200:8000",
                   .run = icd::RunStatus{3, 100, 20, "adit"},
                   .expected = std::nullopt};
  content.settings = "{\"version\": 1}\n";
  content.tokens.emplace("scoring", *icd::BearerToken::parse("scoring-token"));
  content.tokens.emplace("course.A.mapping", *icd::BearerToken::parse("mapping-token"));
  content.ledger = std::string("records\0\n of it", 15);
  content.certificate = "a key and its certificates\n";
  return content;
}

std::string why_unread(const std::string& text) {
  const auto read_again = read(text);
  return read_again ? "" : read_again.error();
}

TEST(Content, ReadsBackTheSame) {
  const auto again = read(write(content()));
  ASSERT_TRUE(again) << again.error();
  EXPECT_EQ(again->about.box, "0123456789abcdef");
  EXPECT_EQ(again->about.run->remaining_reports, 20);
  EXPECT_FALSE(again->about.expected);
  EXPECT_EQ(again->settings, content().settings);
  EXPECT_EQ(again->ledger, content().ledger);
  EXPECT_EQ(again->certificate, content().certificate);
  ASSERT_EQ(again->tokens.size(), 2U);
  EXPECT_EQ(again->tokens.at("course.A.mapping").reveal(), "mapping-token");
}

TEST(Content, MayHaveNoCertificate) {
  Content without = content();
  without.certificate.clear();
  EXPECT_EQ(read(write(without))->certificate, "");
}

TEST(Content, IsRejectedIfTruncated) {
  const std::string text = write(content());
  for (std::size_t size = 0; size < text.size(); ++size)
    EXPECT_NE(why_unread(text.substr(0, size)), "") << size;
}

TEST(Content, HasEachPartOnce) {
  const std::string text = write(content());
  EXPECT_EQ(why_unread(text + "settings 2\n{}"), "cannot read the export: settings is given twice");
  EXPECT_EQ(why_unread(text + "maps 2\n{}"),
            "cannot read the export: it has a part that this version of Adit does not know");
  EXPECT_EQ(why_unread(text + "token:x 3\na b"), "cannot read the export: token:x is not a token");
  EXPECT_EQ(why_unread("settings 2\n{}ledger 1\nx"), "cannot read the export: about is missing");
}

TEST(Content, RejectsInvalidLengths) {
  for (const char* const hostile :
       {"settings 18446744073709551615\n", "settings 18446744073709551616\n", "settings -1\n", "settings \n",
        "settings 3 \nabc", "settings\n", "about 2\n{}", "token: 1\nx"}) {
    EXPECT_NE(why_unread(hostile), "") << hostile;
  }
}

}  // namespace
}  // namespace adit::spare
