#include "intake/head_checker.hpp"

#include <gtest/gtest.h>

#include "intake/odd_heads.hpp"

namespace adit::intake {
namespace {

using Verdict = HeadChecker::Verdict;

/// Checks `bytes` in pieces of this size.
Verdict check(HeadChecker& checker, const std::string& bytes, std::size_t piece) {
  Verdict verdict = Verdict::More;
  for (std::size_t size = piece; verdict == Verdict::More; size += piece) {
    const std::string copy = bytes.substr(0, size);  // at a new address each time
    verdict = checker.check(copy);
    if (size >= bytes.size()) break;
  }
  return verdict;
}

TEST(Heads, AreRejectedIfTheRfcForbidsThem) {
  RecordProperty("cases", static_cast<int>(odd_heads().size()));  // tests/hostile/run counts them
  for (const OddHead& odd : odd_heads()) {
    for (const std::size_t piece : {odd.head.size(), std::size_t{1000}, std::size_t{1}}) {
      if (piece == 1 && odd.head.size() > 5000) continue;
      HeadChecker checker;
      ASSERT_EQ(check(checker, odd.head, piece), Verdict::Refused)
          << odd.clause << " " << odd.what << " " << piece;
      EXPECT_EQ(static_cast<int>(checker.refusal().status), odd.status) << odd.what;
      EXPECT_NE(checker.refusal().sentence.find(odd.word), std::string::npos)
          << odd.what << ": " << checker.refusal().sentence;
    }
  }
}

struct Plain {
  std::string head;
  bool has_body = false;
  std::optional<std::uint64_t> length = 0;
};

TEST(Heads, AreAcceptedIfTheyAreValid) {
  const std::string to = " /echo HTTP/1.1\r\nHost: adit\r\n";
  const Plain rows[] = {
      {"GET" + to + "\r\n"},
      {"\r\n\r\nGET" + to + "\r\n"},
      {"GET /echo HTTP/1.0\r\n\r\n"},
      {"GET /echo HTTP/1.2\r\nHost: adit\r\n\r\n"},
      {"OPTIONS * HTTP/1.1\r\nHost: adit\r\n\r\n"},
      {"GET http://adit/echo HTTP/1.1\r\nHost: adit\r\n\r\n"},
      {"GET HTTP://ADIT:80?q HTTP/1.1\r\nHost: adit:80\r\n\r\n"},
      {"GET /\xc3\xa4?a=|^ HTTP/1.1\r\nHost:\r\n\r\n"},
      {"GET / HTTP/1.1\r\nHost: [fe80::1]:8000\r\n\r\n"},
      {"GET / HTTP/1.1\r\nHost: 10.0.0.1:\r\n\r\n"},
      {"GET" + to + "X:\r\nY:z\r\nZ: \t a\tb \xff \t\r\n\r\n"},
      {"GET" + to +
       "Origin:  null\r\nAuthorization: Bearer a\r\norigin: null \r\nAUTHORIZATION: Bearer a\r\n\r\n"},
      {"PUT" + to +
       "Content-Type: a/b\r\nContent-Type: a/b\r\nContent-Type: a/b\r\nContent-Length: 0\r\n\r\n"},
      {"POST" + to + "Content-Length:  0042\t\r\n\r\n", true, 42},
      {"POST" + to + "Content-Length: 9223372036854775807\r\n\r\n", true, INT64_MAX},
      {"POST" + to + "transfer-encoding: Chunked\r\n\r\n", true, std::nullopt},
  };
  for (const Plain& plain : rows) {
    for (const std::size_t piece : {plain.head.size(), std::size_t{1}}) {
      HeadChecker checker;
      EXPECT_EQ(check(checker, plain.head, piece), Verdict::Whole)
          << plain.head << checker.refusal().sentence;
      EXPECT_EQ(checker.size(), plain.head.size());
      EXPECT_EQ(checker.framing().has_body, plain.has_body) << plain.head;
      EXPECT_EQ(checker.framing().length, plain.length) << plain.head;
    }
  }
}

TEST(Heads, EndWithTheirBlankLine) {
  const std::string head = "POST /echo HTTP/1.1\r\nHost: adit\r\nContent-Length: 3\r\n\r\n";
  HeadChecker checker;
  EXPECT_EQ(checker.check(head + "\nGET /"), Verdict::Whole);
  EXPECT_EQ(checker.size(), head.size());
}

TEST(Heads, HaveALimitedSize) {
  const std::string begin = "GET /echo HTTP/1.1\r\nHost: adit\r\nX: ";
  const std::string most = begin + std::string(HeadChecker::kMostBytes - begin.size() - 4, 'x') + "\r\n\r\n";
  HeadChecker whole, longer;
  EXPECT_EQ(whole.check(most), Verdict::Whole);
  EXPECT_EQ(longer.check("\r\n" + most), Verdict::Refused);
}

}  // namespace
}  // namespace adit::intake
