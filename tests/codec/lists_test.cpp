// Documents whose arrays stay text and are parsed element by element.
#include <gtest/gtest.h>

#include "codec/documents.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"
#include "codec/messages.hpp"
#include "codec/read.hpp"
#include "codec/value.hpp"

namespace adit::codec::test {
namespace {

using namespace std::string_literals;

struct Row {
  BodyKind kind;
  std::string body, expected;
};

TEST(Lists, AreFoundAmongAnySurroundings) {
  const std::string hidden = R"("[\"],{\\")";
  const Row rows[] = {
      {kJsonBody, "[]", "[]"},
      {kJsonBody, "[[],[[]],{}]", "[[],[[]],{}]"},
      {kJsonBody, R"([1, "a,b]", {"x": [2, 3], "[": []}, null])", R"([1,"a,b]",{"x":[2,3],"[":[]},null])"},
      {kJsonBody, "{" + hidden + ":[" + hidden + "," + hidden + "]," + hidden + ":" + hidden + "}",
       "{" + hidden + ":[" + hidden + "," + hidden + "]," + hidden + ":" + hidden + "}"},
      {kJsonBody, "\n[ 1 , [ ] ,\t{ \"a\" : [ 2\r, \"\\u0041\" ] } ] ", R"([1,[],{"a":[2,"A"]}])"},
      {kCborBody, "\x80", "[]"},
      {kCborBody, "\x9f\xff", "[]"},
      {kCborBody, "\x9f\x9f\x01\x02\xff\x80\x81\xa0\xff", "[[1,2],[],[{}]]"},
      {kCborBody, "\xbf\x61"s + "a\x82\x62,]\x7f\x61x\x61y\xff\x61"s + "b\x9f\xbf\xff\xff\xff",
       R"({"a":[",]","xy"],"b":[{}]})"},
      // Arrays in skipped parts: a key that is not text, and its value.
      {kCborBody, "\xa3\x81\x01\x82\x02\x03\x61"s + "a\x81\x04\x41\xff\x81\x05", R"({"a":[4]})"},
  };
  for (const auto& [kind, body, expected] : rows) {
    const auto whole = decode(kind, Split::Nothing, body);
    const auto listed = decode(kind, Split::Lists, body);
    ASSERT_TRUE(whole && listed) << expected;
    EXPECT_EQ(write_json(whole->root), expected);
    EXPECT_EQ(write_json(listed->root), expected);
  }
}

TEST(Lists, AreParsedOnFirstUse) {
  const auto document = decode(kJsonBody, Split::Lists, R"({"a": [1, {"b": [2]}]})");
  ASSERT_TRUE(document);
  Reading reading;
  const Field body(document->root, reading);
  const Field list = body.member("a");
  EXPECT_FALSE(list.is<Value::Array>());
  ASSERT_EQ(list.size(), 2u);
  const Field element = list.element(1);
  const Field inner = element.member("b");
  EXPECT_EQ(inner.element(0).integer<int>(), 2);
  EXPECT_EQ(inner.element(0).path(), "a[1].b[0]");
  EXPECT_EQ(list.element(0).integer<int>(), 1);
  EXPECT_FALSE(reading.has_refusal());
  EXPECT_EQ(list.text(), "");
  EXPECT_EQ(reading.outcome(0).error().sentence, "a: expected a string, got an array");
}

/// A fast parser for objects of numbers. It must reject everything that the general parser reads
/// differently.
TEST(Lists, GiveTheNumbersOfAnObjectWithExactlyTheseMembers) {
  constexpr std::string_view kNames[] = {"x", "y"};
  struct Element {
    BodyKind kind;
    std::string body;
    bool is_read;
  };
  const std::string y = "\x61y"s, x = "\x61x"s, half = "\xf9\x38\x00"s;
  const Element elements[] = {
      {kJsonBody, R"([{"x": 0.5, "y": -2e1}])", true},
      {kJsonBody, R"([{"x": 0.5, "y": -20}])", true},
      {kJsonBody, "[ {\n \"x\" : 0.5 , \"y\" :\t-20 } ]", true},
      {kJsonBody, R"([{"y": -20, "x": 0.5}])", false},
      {kJsonBody, R"([{"x": 0.5}])", false},
      {kJsonBody, R"([{"x": 0.5, "y": -20, "z": 0}])", false},
      {kJsonBody, R"([{"x": 0.5, "y": "-20"}])", false},
      {kJsonBody, R"([{"x": 0.5, "y": null}])", false},
      {kJsonBody, R"([{"x": 0.5, "y": [-20]}])", false},
      {kJsonBody, R"([{"x": 0.5, "yy": -20}])", false},
      {kJsonBody, R"([[0.5, -20]])", false},
      {kJsonBody, "[5]", false},
      {kCborBody, "\x81\xa2" + x + half + y + "\x33", true},
      {kCborBody, "\x81\xa2" + x + "\xfa\x3f\x00\x00\x00"s + y + "\xfb\xc0\x34\x00\x00\x00\x00\x00\x00"s,
       true},
      {kCborBody, "\x81\xa2" + y + "\x33" + x + half, false},
      {kCborBody, "\x81\xbf" + x + half + y + "\x33\xff", false},
      {kCborBody, "\x81\xa1" + x + half, false},
      {kCborBody, "\x81\xa2" + x + half + y + "\xf4", false},
      {kCborBody, "\x81\xa2" + x + half + y + "\xf9\x7e\x00"s, false},  // NaN
      {kCborBody, "\x81\xa2" + x + half + "\x41y\x33", false},
      {kCborBody, "\x81\xa2" + x + half + y + "\x81\x33", false},
      {kCborBody, "\x81\x05", false},
  };
  for (const auto& [kind, body, is_read] : elements) {
    const auto document = decode(kind, Split::Lists, body);
    ASSERT_TRUE(document) << body;
    Reading reading;
    const Field list(document->root, reading);
    double numbers[2] = {};
    ASSERT_EQ(list.reals(0, kNames, numbers), is_read) << body;
    if (is_read) EXPECT_EQ(std::pair(numbers[0], numbers[1]), std::pair(0.5, -20.0)) << body;
    EXPECT_FALSE(reading.has_refusal()) << body;
  }
}

/// Errors inside lists are the same for a document in one piece and in many pieces.
TEST(Lists, AreWellFormed) {
  for (const std::string inside : {"1 2", "1,", ",1", "01", "-", "1.", "tru", "\"", "\"\\x\"", "{\"a\":}",
                                   "{1:2}", "{\"a\" 1}", "[", "1e999", "\"\xff\""}) {
    const std::string body = "{\"a\": [" + inside + "]}";
    const auto whole = decode(kJsonBody, Split::Nothing, body);
    const auto listed = decode(kJsonBody, Split::Lists, body);
    ASSERT_FALSE(listed) << body;
    EXPECT_EQ(listed.error().sentence, whole.error().sentence) << body;
  }
}

/// Limits the tree of a message, whatever the length of its lists.
TEST(Lists, LeaveFewOtherValues) {
  const auto members = [](std::size_t count, std::string_view before, std::string_view after) {
    std::string body(before);
    for (std::size_t i = 0; i < count; ++i) body += "\"\":0,";
    body.pop_back();
    return body.append(after);
  };
  EXPECT_TRUE(decode(kJsonBody, Split::Lists, members(kMostOutsideLists - 1, "{", "}")));
  const auto at_the_top = decode(kJsonBody, Split::Lists, members(kMostOutsideLists, "{", "}"));
  ASSERT_FALSE(at_the_top);
  EXPECT_EQ(at_the_top.error().status, icd::Status::ContentTooLarge);
  const auto marker = decode(kJsonBody, Split::Lists, members(kMostOutsideLists, "{\"markers\":[{", "}]}"));
  ASSERT_TRUE(marker);
  EXPECT_EQ(test::sentence_of(read_markers_update(*marker, {})),
            "markers[0]: more than the limit of 20000 values outside lists");
  const std::string cbor =
      "\xb9\x4e\x20"s + std::string(2 * kMostOutsideLists, '\x60');  // 20,000 members, their names and values
  const auto map = decode(kCborBody, Split::Lists, cbor);
  ASSERT_FALSE(map);
  EXPECT_EQ(map.error().sentence, "more than the limit of 20000 values outside lists");
}

}  // namespace
}  // namespace adit::codec::test
