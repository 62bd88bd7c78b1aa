#include <gtest/gtest.h>

#include "codec/documents.hpp"
#include "codec/splitter.hpp"

namespace adit::codec::test {
namespace {

TEST(PlainElements, CountARunOfEqualElements) {
  struct Case {
    std::string_view text;
    int value;  // -1: no element
    std::size_t count;
    std::string_view rest;
  };
  const std::vector<Case> cases = {
      {"0,", 0, 1, ""},
      {"-1, -1, -1, 0", 255, 1, " -1, -1, 0"},
      {" -1, -1, -1, 0", 255, 3, " 0"},
      {"7,7,7,71,", 7, 3, "71,"},
      {"255 ,255 ,25", 255, 2, "25"},
      {"100\n,\n", 100, 1, "\n"},
      {"12,12,12", 12, 2, "12"},
      {"0", -1, 0, ""},
      {"0]", -1, 0, ""},
      {"00,", -1, 0, ""},
      {"01,", -1, 0, ""},
      {"256,", -1, 0, ""},
      {"1000,", -1, 0, ""},
      {"-2,", -1, 0, ""},
      {"-10,", -1, 0, ""},
      {"-1", -1, 0, ""},
      {"-0,", -1, 0, ""},
      {"1.0,", -1, 0, ""},
      {"1e1,", -1, 0, ""},
      {",", -1, 0, ""},
      {"", -1, 0, ""},
      {"  ", -1, 0, ""},
      {"\f1,", -1, 0, ""},
  };
  for (const Case& row : cases) {
    std::string_view text = row.text;
    const auto elements = take_plain_elements(text);
    ASSERT_EQ(elements.has_value(), row.value >= 0) << row.text;
    EXPECT_EQ(text, elements ? row.rest : row.text);
    if (!elements) continue;
    EXPECT_EQ(int{elements->value}, row.value) << row.text;
    EXPECT_EQ(elements->count, row.count) << row.text;
  }
}

TEST(PlainElements, CountARunOfEqualCborElements) {
  struct Case {
    std::string_view hex;
    std::uint64_t most;
    int value;  // -1: no element
    std::size_t count;
    std::string_view rest;
  };
  const std::vector<Case> cases = {{"00", 1, 0, 1, ""},
                                   {"17 17 17 16", 9, 23, 3, "16"},
                                   {"20 20 20", 2, 255, 2, "20"},
                                   {"18 64 18 64", 9, 100, 2, ""},
                                   {"18 64 18 65", 9, 100, 1, "1865"},
                                   {"18 00 00", 9, 0, 1, "00"},
                                   {"18", 9, -1, 0, "18"},
                                   {"", 9, -1, 0, ""},
                                   {"19 0001", 9, -1, 0, "190001"},
                                   {"21", 9, -1, 0, "21"},
                                   {"38 00", 9, -1, 0, "3800"},
                                   {"ff", 9, -1, 0, "ff"},
                                   {"f6", 9, -1, 0, "f6"},
                                   {"c1 00", 9, -1, 0, "c100"},
                                   {"80", 9, -1, 0, "80"}};
  for (const Case& row : cases) {
    const std::string bytes = from_hex(row.hex);
    std::string_view left = bytes;
    const auto elements = take_plain_cbor_elements(left, row.most);
    ASSERT_EQ(elements.has_value(), row.value >= 0) << row.hex;
    EXPECT_EQ(left, from_hex(row.rest)) << row.hex;
    if (!elements) continue;
    EXPECT_EQ(int{elements->value}, row.value) << row.hex;
    EXPECT_EQ(elements->count, row.count) << row.hex;
  }
}

}  // namespace
}  // namespace adit::codec::test
