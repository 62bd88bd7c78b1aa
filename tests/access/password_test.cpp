#include "access/password.hpp"

#include <gmock/gmock.h>

namespace adit::access {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(Password, Has10To128Characters) {
  EXPECT_FALSE(check_new("123456789"));
  EXPECT_TRUE(check_new("1234567890"));
  EXPECT_TRUE(check_new("gr\xc3\xbc\xc3\x9f Gott!"));  // 10 characters in 12 bytes
  EXPECT_FALSE(check_new("gr\xc3\xbc\xc3\x9f Gott"));
  EXPECT_TRUE(check_new(std::string(128, 'x')));
  EXPECT_FALSE(check_new(std::string(129, 'x')));
  EXPECT_FALSE(check_new("tab\tin the middle"));
  EXPECT_FALSE(check_new(std::string("a NUL\0 in it", 12)));
  EXPECT_EQ(check_new("short").error(), "expected 10 to 128 characters, got 5");
}

TEST(Password, IsHashedByYescryptWithItsOwnSalt) {
  const auto one = hash("correct horse", {1}), other = hash("correct horse", {2});
  ASSERT_TRUE(one && other);
  EXPECT_THAT(*one, StartsWith("$y$j9T$"));
  EXPECT_NE(*one, *other);
  EXPECT_THAT(*one, Not(HasSubstr("horse")));
  EXPECT_EQ(hash("correct horse", {1}), one);
}

TEST(Password, MatchesOnlyItsHash) {
  const std::string hashed = hash("correct horse", {1}).value();
  EXPECT_TRUE(matches("correct horse", hashed));
  for (const std::string& wrong :
       {std::string(), std::string("Correct horse"), std::string("correct horse "), std::string(600, 'x')}) {
    EXPECT_FALSE(matches(wrong, hashed)) << wrong;
  }
  for (const char* damaged : {"", "*0", "$y$", "$y$j9T$", "no hash"}) {
    EXPECT_FALSE(matches("correct horse", damaged)) << damaged;
  }
}

TEST(Password, OfTheGreatestLengthCanBeHashed) {
  const std::string longest(kMostBytes, 'x');
  const auto hashed = hash(longest, {3});
  ASSERT_TRUE(hashed);
  EXPECT_TRUE(matches(longest, *hashed));
}

TEST(Code, HasEightDigits) {
  EXPECT_TRUE(is_code("01234567"));
  for (const char* text : {"", "1234567", "123456789", "1234567a", "1234 678"}) {
    EXPECT_FALSE(is_code(text)) << text;
  }
  for (const std::uint64_t random : {0ull, 1ull, 99999999ull, ~0ull}) EXPECT_TRUE(is_code(code_from(random)));
  EXPECT_EQ(code_from(0), "00000000");
  EXPECT_NE(code_from(123), code_from(124));
}

}  // namespace
}  // namespace adit::access
