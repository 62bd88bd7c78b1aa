#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "codec/gzip.hpp"
#include "scarce_memory.hpp"
#include "uplink/exchange.hpp"

namespace adit::uplink {
namespace {

using State = AnswerParser::State;
constexpr std::size_t kLongest = Request::kLongestAnswer;
using testing::HasSubstr;

// NOLINTNEXTLINE(clang-analyzer-optin.performance.Padding): in the order in which a case reads
struct Case {
  const char* name;
  std::string bytes;
  bool end;  // the peer then closes the connection
  State state;
  int status = 0;
  const char* body = "";
  bool keeps_alive = false;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

const Case kCases[] = {
    {"a length", "HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nnull", false, State::Whole, 200, "null", true},
    {"201", "HTTP/1.1 201 Created\r\nContent-Length: 2\r\n\r\n{}", false, State::Whole, 201, "{}", true},
    {"no reason phrase", "HTTP/1.1 200 \r\nContent-Length: 0\r\n\r\n", false, State::Whole, 200, "", true},
    {"chunked", "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n2;x=y\r\nde\r\n0\r\n\r\n",
     false, State::Whole, 200, "abcde", true},
    {"chunked, and empty", "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", false,
     State::Whole, 200, "", true},
    {"204 without a length", "HTTP/1.1 204 No Content\r\n\r\n", false, State::Whole, 204, "", true},
    {"says close", "HTTP/1.1 200 OK\r\nConnection: close\r\nContent-Length: 2\r\n\r\nhi", false, State::Whole,
     200, "hi", false},
    {"HTTP/1.0", "HTTP/1.0 200 OK\r\nContent-Length: 2\r\n\r\nhi", false, State::Whole, 200, "hi", false},
    {"HTTP/1.0 that keeps alive", "HTTP/1.0 200 OK\r\nConnection: keep-alive\r\nContent-Length: 2\r\n\r\nhi",
     false, State::Whole, 200, "hi", true},
    {"a body until the end", "HTTP/1.0 500 Oops\r\n\r\n<html>", true, State::Whole, 500, "<html>", false},
    {"bytes beyond the answer", "HTTP/1.1 200 OK\r\nContent-Length: 2\r\n\r\nhiHTTP/1.1", false, State::Whole,
     200, "hi", false},
    {"1xx first",
     "HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 103 Early Hints\r\nA: b\r\n\r\nHTTP/1.1 200 "
     "OK\r\nContent-Length: "
     "2\r\n\r\nhi",
     false, State::Whole, 200, "hi", true},
    {"only 1xx", "HTTP/1.1 102 Processing\r\n\r\n", false, State::Incomplete},
    {"half a head", "HTTP/1.1 200 OK\r\nContent-Le", false, State::Incomplete},
    {"half a body", "HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nnu", false, State::Incomplete},
    {"a body without end yet", "HTTP/1.1 200 OK\r\n\r\nnull", false, State::Incomplete},

    {"nothing", "", true, State::Malformed},
    {"only 1xx, and the end", "HTTP/1.1 100 Continue\r\n\r\n", true, State::Malformed},
    {"half a head, and the end", "HTTP/1.1 200 OK\r\nContent-Le", true, State::Malformed},
    {"half a body, and the end", "HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nnu", true, State::Malformed},
    {"half a chunked body, and the end", "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n",
     true, State::Malformed},
    {"garbage", "220 smtp.example.org ESMTP\r\n\r\n", false, State::Malformed},
    {"binary garbage", std::string("\0\1\2\3\xff\xfe", 6), true, State::Malformed},
    {"TLS", std::string("\x15\x03\x01\x00\x02\x02\x46", 7), true, State::Malformed},
    {"HTTP/2", "HTTP/2.0 200 OK\r\n\r\n", false, State::Malformed},
    {"a negative length", "HTTP/1.1 200 OK\r\nContent-Length: -1\r\n\r\n", false, State::Malformed},
    {"two lengths", "HTTP/1.1 200 OK\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", false,
     State::Malformed},
    {"a length of 2^64", "HTTP/1.1 200 OK\r\nContent-Length: 18446744073709551616\r\n\r\n", false,
     State::Malformed},
    {"a length of 5 GB", "HTTP/1.1 200 OK\r\nContent-Length: 5000000000\r\n\r\n", false, State::Malformed},
    {"a length of 30 GB, which no memory holds", "HTTP/1.1 200 OK\r\nContent-Length: 30000000000\r\n\r\n",
     false, State::Malformed},
    {"a length just beyond the limit", "HTTP/1.1 200 OK\r\nContent-Length: 65537\r\n\r\n", false,
     State::Malformed},
    {"a length of 2^63", "HTTP/1.1 200 OK\r\nContent-Length: 9223372036854775808\r\n\r\n", false,
     State::Malformed},
    {"1xx of 30 GB", "HTTP/1.1 100 Continue\r\nContent-Length: 30000000000\r\n\r\n", false,
     State::Incomplete},
    {"a chunk of 30 GB", "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n6fc23ac00\r\nab", false,
     State::Malformed},
    {"a chunk of 2^64", "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n10000000000000000\r\nab", false,
     State::Malformed},
    {"a chunk of no size", "HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\nxyz\r\n", false,
     State::Malformed},
    {"101", "HTTP/1.1 101 Switching Protocols\r\nUpgrade: x\r\n\r\n", false, State::Malformed},
    {"status 099", "HTTP/1.1 099 Low\r\nContent-Length: 0\r\n\r\n", false, State::Malformed},
    {"status 600", "HTTP/1.1 600 High\r\nContent-Length: 0\r\n\r\n", false, State::Malformed},
};

class AnswerParserCases : public testing::TestWithParam<Case> {};

/// Feeds the bytes in pieces of `portion`.
State feed(AnswerParser& parser, const Case& c, std::size_t portion) {
  State state = State::Incomplete;
  for (std::size_t at = 0; at < c.bytes.size() && state == State::Incomplete; at += portion)
    state = parser.feed(std::string_view(c.bytes).substr(at, portion));
  if (state == State::Incomplete && c.end) state = parser.feed_end();
  return state;
}

TEST_P(AnswerParserCases, AreReadTheSameInAnyPieces) {
  const Case& c = GetParam();
  for (std::size_t portion = 1; portion <= c.bytes.size() + 1; ++portion) {
    SCOPED_TRACE(portion);
    AnswerParser parser(kLongest);
    ASSERT_EQ(feed(parser, c, portion), c.state) << parser.fault();
    if (c.state == State::Malformed) {
      EXPECT_NE(parser.fault(), "");
    }
    if (c.state != State::Whole) continue;
    // If the bytes were cut right after the answer, the parser has not seen the rest.
    const bool saw_all = portion > c.bytes.size();
    if (saw_all || c.keeps_alive) {
      EXPECT_EQ(parser.can_keep_alive(), c.keeps_alive);
    }
    const Answered answered = parser.take_answer();
    EXPECT_EQ(answered.status, c.status);
    EXPECT_EQ(answered.body, c.body);
  }
}

INSTANTIATE_TEST_SUITE_P(, AnswerParserCases, testing::ValuesIn(kCases));

std::optional<std::chrono::seconds> retry_after(const std::string& value, const std::string& date = "") {
  AnswerParser parser(kLongest);
  EXPECT_EQ(parser.feed("HTTP/1.1 429 Slow\r\nContent-Length: 0\r\nDate: " + date +
                        "\r\nRetry-After: " + value + "\r\n\r\n"),
            State::Whole);
  return parser.take_answer().retry_after;
}

TEST(AnswerParser, ReadsRetryAfterInSeconds) {
  constexpr std::chrono::seconds kDay = std::chrono::days(1);
  EXPECT_EQ(retry_after("0"), std::chrono::seconds(0));
  EXPECT_EQ(retry_after("120"), std::chrono::seconds(120));
  for (const char* long_time : {"86401", "999999999", "2147483648", "99999999999999999999"})
    EXPECT_EQ(retry_after(long_time), kDay) << long_time;
  for (const char* none : {"", "-1", "1.5", "soon", "12 s", "+3"}) EXPECT_EQ(retry_after(none), std::nullopt);
}

/// The Command Post's clock may be months off.
TEST(AnswerParser, ReadsRetryAfterAsADateByTheAnswersOwnDate) {
  const char* const now = "Fri, 31 Dec 1999 23:59:50 GMT";
  EXPECT_EQ(retry_after("Sat, 01 Jan 2000 00:00:02 GMT", now), std::chrono::seconds(12));
  EXPECT_EQ(retry_after(now, now), std::chrono::seconds(0));
  EXPECT_EQ(retry_after("Fri, 31 Dec 1999 23:59:00 GMT", now), std::chrono::seconds(0)) << "over";
  EXPECT_EQ(retry_after("Sat, 01 Jan 2050 00:00:00 GMT", now), std::chrono::seconds(std::chrono::days(1)));
  EXPECT_EQ(retry_after("Sat, 01 Jan 2000 00:00:02 GMT"), std::nullopt) << "no Date";
}

std::string decoded(const std::string& coding, const std::string& body) {
  AnswerParser parser(kLongest);
  EXPECT_EQ(parser.feed("HTTP/1.1 200 OK\r\nContent-Encoding: " + coding +
                        "\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body),
            State::Whole);
  return parser.take_answer().body;
}

std::string gzipped(const std::string& text) {
  const auto member = codec::gzip({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                                  codec::kFastestLevel, 1u << 20);
  std::string bytes;
  for (const auto& chunk : member->chunks()) bytes.append(chunk->begin(), chunk->end());
  return bytes;
}

/// Adit asks for no coding, but some servers compress all answers.
TEST(AnswerParser, DecodesABodyWithinItsLimit) {
  const std::string longest(kLongest, 'x');
  for (const char* name : {"gzip", "GZip", "x-gzip"})
    EXPECT_EQ(decoded(name, gzipped("null")), "null") << name;
  EXPECT_EQ(decoded("gzip", gzipped(longest)), longest);
  const std::string cut = gzipped("null").substr(0, 15);
  for (const std::string& bytes : {gzipped(longest + "x"), cut, std::string("null"), gzipped("null") + "x"})
    EXPECT_EQ(decoded("gzip", bytes), bytes);
  EXPECT_EQ(decoded("br", "bytes"), "bytes");
  EXPECT_EQ(decoded("identity", "null"), "null");
  EXPECT_EQ(decoded("gzip", ""), "");
}

TEST(AnswerParser, GivesTheContentTypeUnchanged) {
  AnswerParser parser(kLongest);
  ASSERT_EQ(
      parser.feed("HTTP/1.1 500 Oops\r\ncontent-TYPE: text/html; charset=utf-8\r\nContent-Length: 0\r\n\r\n"),
      State::Whole);
  EXPECT_EQ(parser.take_answer().content_type, "text/html; charset=utf-8");
}

TEST(AnswerParser, AcceptsAnAnswerOfExactlyTheLimit) {
  const std::string body(kLongest, 'x');
  AnswerParser parser(kLongest);
  EXPECT_EQ(
      parser.feed("HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body),
      State::Whole);
  EXPECT_EQ(parser.take_answer().body, body);
}

TEST(AnswerParser, StreamsAnAnswerOfAnyLength) {
  for (const bool is_chunked : {false, true}) {
    AnswerParser parser(kLongest);
    EXPECT_EQ(parser.status(), 0);
    ASSERT_EQ(parser.feed("HTTP/1.1 200 OK\r\nX: y\r\n"), State::Incomplete);
    EXPECT_EQ(parser.status(), 0);
    ASSERT_EQ(parser.feed(is_chunked ? "Transfer-Encoding: chunked\r\n\r\n" : "\r\n"), State::Incomplete);
    EXPECT_EQ(parser.status(), 200);
    EXPECT_EQ(parser.take_part(), "");
    const std::string part(kLongest / 2, 'x');
    std::ostringstream size;
    size << std::hex << part.size() << "\r\n";
    for (int i = 0; i < 20; ++i) {
      const std::string piece = is_chunked ? size.str() + part + "\r\n" : part;
      ASSERT_EQ(parser.feed(piece), State::Incomplete) << parser.fault();
      ASSERT_EQ(parser.take_part(), part);
    }
    EXPECT_EQ(is_chunked ? parser.feed("0\r\n\r\n") : parser.feed_end(), State::Whole);
    EXPECT_EQ(parser.take_answer().body, "");
  }
}

/// The status tells which server answered.
TEST(AnswerParser, KnowsTheStatusOfATooLongAnswer) {
  const std::string long_body(2 * kLongest, 'x');
  const std::pair<std::string, int> cases[] = {
      {"HTTP/1.1 302 Found\r\nContent-Length: 30000000000\r\n\r\n", 302},
      {"HTTP/1.1 200 OK\r\n\r\n" + long_body, 200},
      {"HTTP/1.1 403 No\r\nTransfer-Encoding: chunked\r\n\r\nffffff\r\n" + long_body, 403},
      {"HTTP/1.1 200 OK\r\nX: " + std::string(AnswerParser::kLongestHead, 'x'), 0},
      {"HTTP/1.1 200 what\r\nno field\r\n\r\n", 0}};
  for (const auto& [bytes, status] : cases) {
    SCOPED_TRACE(bytes.substr(0, 60));
    AnswerParser parser(kLongest);
    EXPECT_EQ(parser.feed(bytes), State::Malformed);
    EXPECT_EQ(parser.too_long_status(), status);
  }
}

TEST(AnswerParser, RejectsEndlessAnswers) {
  const std::pair<std::string, std::string> endless[] = {
      {"", "HTTP/1.1 100 Continue\r\n\r\n"},                                    // interim answers
      {"HTTP/1.1 200 OK\r\n", "X-Field: 0123456789\r\n"},                       // a head
      {"HTTP/1.1 200 OK\r\n\r\n", std::string(1000, 'x')},                      // a body without length
      {"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n", "1\r\nx\r\n"},  // chunks
      {"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n1;", "extension"}};
  for (const auto& [begin, more] : endless) {
    SCOPED_TRACE(begin + more.substr(0, 30));
    AnswerParser parser(kLongest);
    State state = parser.feed(begin.empty() ? more : begin);
    std::size_t fed = begin.size();
    for (; state == State::Incomplete && fed < (2u << 20); fed += more.size()) state = parser.feed(more);
    EXPECT_EQ(state, State::Malformed);
    EXPECT_THAT(parser.fault(), HasSubstr("too long"));
  }
}

TEST(AnswerParser, ExceptionFailsOnlyThatAnswer) {
  AnswerParser parser(kLongest);
  ScarceMemory scarce(0, 1);
  const State state = parser.feed("HTTP/1.1 200 OK\r\nContent-Length: 4\r\n\r\nnull");
  EXPECT_GT(scarce.end(), 0u);
  EXPECT_EQ(state, State::Malformed);
}

TEST(HttpDate, IsSecondsSince1970) {
  const auto date = http_date("Sun, 06 Nov 1994 08:49:37 GMT");
  ASSERT_TRUE(date);
  EXPECT_EQ(date->time_since_epoch().count(), 784111777);
  EXPECT_EQ(http_date("Thu, 01 Jan 1970 00:00:00 GMT")->time_since_epoch().count(), 0);
}

TEST(HttpDate, IsRejectedInOtherForms) {
  for (const char* text :
       {"", "Sunday, 06-Nov-94 08:49:37 GMT", "Sun Nov  6 08:49:37 1994", "Sun, 06 Nov 1994 08:49:37 UTC",
        "Sun, 31 Feb 1994 08:49:37 GMT", "Sun, 00 Nov 1994 08:49:37 GMT", "Sun, 06 Nox 1994 08:49:37 GMT",
        "Sun, 06 Nov 1994 24:49:37 GMT", "Sun, 06 Nov 1994 08:60:37 GMT", "Sun, -6 Nov 1994 08:49:37 GMT",
        "Sun, 06 Nov 1994 08:49:3x GMT", "Sun, 06 Nov 1994 08-49-37 GMT", "Sun, 06 Nov 1994 08:49:37 GMT "}) {
    EXPECT_FALSE(http_date(text)) << text;
  }
}

TEST(HttpDate, IsReadFromAnAnswer) {
  AnswerParser parser(Request::kLongestAnswer);
  ASSERT_EQ(
      parser.feed("HTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nContent-Length: 0\r\n\r\n"),
      AnswerParser::State::Whole);
  EXPECT_EQ(parser.take_answer().date->time_since_epoch().count(), 784111777);
}

}  // namespace
}  // namespace adit::uplink
