// Documents whose arrays are left as text, and parsed element by element.
#include <gtest/gtest.h>

#include "codec/documents.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"
#include "codec/list.hpp"
#include "codec/messages.hpp"
#include "codec/read.hpp"

namespace adit::codec::test {
namespace {

using namespace std::string_literals;

struct Row {
  BodyKind kind;
  std::string body, says;
};

TEST(Lists, AreWhereTheyStandWhateverIsAroundThem) {
  const std::string hidden = R"("[\"],{\\")";
  const Row rows[] = {
      {kJsonBody, "[]", "[]"},
      {kJsonBody, "[[],[[]],{}]", "[[],[[]],{}]"},
      {kJsonBody, R"([1, "a,b]", {"x": [2, 3], "[": []}, null])", R"([1,"a,b]",{"x":[2,3],"[":[]},null])"},
      {kJsonBody, "{" + hidden + ":[" + hidden + "," + hidden + "]," + hidden + ":" + hidden + "}",
       "{" + hidden + ":[" + hidden + "," + hidden + "]," + hidden + ":" + hidden + "}"},
      {kCborBody, "\x80", "[]"},
      {kCborBody, "\x9f\xff", "[]"},
      {kCborBody, "\x9f\x9f\x01\x02\xff\x80\x81\xa0\xff", "[[1,2],[],[{}]]"},
      {kCborBody, "\xbf\x61"s + "a\x82\x62,]\x7f\x61x\x61y\xff\x61"s + "b\x9f\xbf\xff\xff\xff",
       R"({"a":[",]","xy"],"b":[{}]})"},
      // Arrays among what is passed over: a key that is no text, and its value.
      {kCborBody, "\xa3\x81\x01\x82\x02\x03\x61"s + "a\x81\x04\x41\xff\x81\x05", R"({"a":[4]})"},
  };
  for (const auto& [kind, body, says] : rows) {
    const auto whole = decode(kind, Split::Nothing, body);
    const auto listed = decode(kind, Split::Lists, body);
    ASSERT_TRUE(whole && listed) << says;
    EXPECT_EQ(write_json(whole->root), says);
    EXPECT_EQ(write_json(listed->root), says);
  }
}

TEST(Lists, AreNotParsedBeforeAnElementIsAskedFor) {
  const auto document = decode(kJsonBody, Split::Lists, R"({"a": [1, {"b": [2]}]})");
  ASSERT_TRUE(document);
  Reading reading;
  const Field body(document->root, reading);
  const Field list = body.member("a");
  EXPECT_FALSE(list.is<Value::Array>());
  ASSERT_EQ(list.size(), 2u);
  const Field element = list.element(1);
  const Field inner = element.member("b");
  EXPECT_EQ(inner.element(0).whole<int>(), 2);
  EXPECT_EQ(inner.element(0).path(), "a[1].b[0]");
  EXPECT_EQ(list.element(0).whole<int>(), 1);
  EXPECT_FALSE(reading.refused());
  EXPECT_EQ(list.text(), "");
  EXPECT_EQ(reading.outcome(0).error().sentence, "a: expected a string, got an array");
}

/// However long its lists are, of a message there is no more than this as a tree.
TEST(Lists, LeaveFewValuesOutsideThem) {
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
