#include "icd/sentence.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace adit::icd {
namespace {

TEST(Sentence, JoinsStringsAndNumbers) {
  EXPECT_EQ(sentence("fields[", std::size_t{2}, "]: expected ", 0.5, ", got ", -3, std::string("!")),
            "fields[2]: expected 0.5, got -3!");
}

TEST(Sentence, ShowsNumbersInTheFewestDigits) {
  EXPECT_EQ(number_text(0.1), "0.1");
  EXPECT_EQ(number_text(2), "2");
  EXPECT_EQ(number_text(-1e300), "-1e+300");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(number_text(std::numeric_limits<double>::infinity()), "inf");
  EXPECT_EQ(number_text(-2.2250738585072014e-308), "-2.2250738585072014e-308");
}

TEST(SizeText, SaysTheTrueSize) {
  EXPECT_EQ(size_text(0), "0 B");
  EXPECT_EQ(size_text(999), "999 B");
  EXPECT_EQ(size_text(1000), "1 kB");
  EXPECT_EQ(size_text(64'499), "64 kB");
  EXPECT_EQ(size_text(999'499), "999 kB");
  EXPECT_EQ(size_text(999'500), "1 MB");
  EXPECT_EQ(size_text(3'449'999), "3.4 MB");
  EXPECT_EQ(size_text(268'000'000), "268 MB");
  EXPECT_EQ(size_text(std::numeric_limits<std::uint64_t>::max()), "18446744073709.6 MB");
}

TEST(InQuotes, KeepsForeignTextShortAndOnOneLine) {
  EXPECT_EQ(quote_text("map"), "\"map\"");
  EXPECT_EQ(quote_text(""), "\"\"");
  EXPECT_EQ(quote_text("a\nb\x7f\x1b[2J"), "\"a?b??[2J\"");
  EXPECT_EQ(quote_text(std::string(40, 'a')), "\"" + std::string(40, 'a') + "\"");
  EXPECT_EQ(quote_text(std::string(4000, 'a')), "\"" + std::string(40, 'a') + "...\"");
}

TEST(InQuotes, SplitsNoCharacter) {
  const std::string text = std::string(39, 'a') + "\xc3\xa9\xc3\xa9";
  EXPECT_EQ(quote_text(text), "\"" + std::string(39, 'a') + "...\"");
  EXPECT_EQ(quote_text(std::string(100, '\x80')), "\"...\"");
}

TEST(Unprocessable, Is422) {
  const Checked<void> refused = unprocessable("a", 1);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error(), (Refusal{Status::UnprocessableEntity, "a1"}));
}

}  // namespace
}  // namespace adit::icd
