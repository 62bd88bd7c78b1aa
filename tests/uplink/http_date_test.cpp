#include "uplink/http_date.hpp"

#include <gtest/gtest.h>

#include "uplink/answer_parser.hpp"

namespace adit::uplink {
namespace {

TEST(AnHttpDate, IsTheSecondsSince1970) {
  const auto date = http_date("Sun, 06 Nov 1994 08:49:37 GMT");
  ASSERT_TRUE(date);
  EXPECT_EQ(date->time_since_epoch().count(), 784111777);
  EXPECT_EQ(http_date("Thu, 01 Jan 1970 00:00:00 GMT")->time_since_epoch().count(), 0);
}

TEST(AnHttpDate, IsNothingElse) {
  for (const char* text :
       {"", "Sunday, 06-Nov-94 08:49:37 GMT", "Sun Nov  6 08:49:37 1994", "Sun, 06 Nov 1994 08:49:37 UTC",
        "Sun, 31 Feb 1994 08:49:37 GMT", "Sun, 00 Nov 1994 08:49:37 GMT", "Sun, 06 Nox 1994 08:49:37 GMT",
        "Sun, 06 Nov 1994 24:49:37 GMT", "Sun, 06 Nov 1994 08:60:37 GMT", "Sun, -6 Nov 1994 08:49:37 GMT",
        "Sun, 06 Nov 1994 08:49:3x GMT", "Sun, 06 Nov 1994 08-49-37 GMT", "Sun, 06 Nov 1994 08:49:37 GMT "}) {
    EXPECT_FALSE(http_date(text)) << text;
  }
}

TEST(AnHttpDate, ComesWithAnAnswer) {
  AnswerParser parser(Request::kLongestAnswer);
  ASSERT_EQ(
      parser.feed("HTTP/1.1 200 OK\r\nDate: Sun, 06 Nov 1994 08:49:37 GMT\r\nContent-Length: 0\r\n\r\n"),
      AnswerParser::State::Whole);
  EXPECT_EQ(parser.take().date->time_since_epoch().count(), 784111777);
}

}  // namespace
}  // namespace adit::uplink
