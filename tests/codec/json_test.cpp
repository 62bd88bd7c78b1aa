#include "codec/json.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "codec/documents.hpp"
#include "icd/sentence.hpp"

namespace adit::codec::test {
namespace {

TEST(Json, ParsesOrTellsTheFault) {
  const auto value = parse_json(R"({"a":[1,2.5,"x",null,true]})");
  ASSERT_TRUE(value);
  EXPECT_TRUE(equals(*value, nlohmann::ordered_json::parse(R"({"a":[1,2.5,"x",null,true]})")));
  EXPECT_EQ(parse_json("[1,]").error(), "not well-formed JSON at byte 3: expected a value, got ']'");
  EXPECT_EQ(parse_json("nul").error(), "not well-formed JSON at byte 3: the document is cut short");
  EXPECT_EQ(parse_json("").error(), "not well-formed JSON at byte 0: an empty document");
}

TEST(Json, IsDistinguishedFromOtherText) {
  for (const char* text : {"{}", " null ", "\"x\"", "1e5", "{\"msg\":{\"data\":\"!\",\"data\":1}}"}) {
    EXPECT_TRUE(parse_json(text)) << text;
  }
  for (const char* text : {"", " ", "{", "<html>", "{} {}", "nul", "\"", "1e", "1e999", "{\"a\"}"}) {
    EXPECT_FALSE(parse_json(text)) << text;
  }
}

TEST(Json, IsWrittenOnOneLineAndReadsBackTheSame) {
  const std::string text =
      R"({"a":[1,-2,2.5,1e+300,18446744073709551615,true,false,null,[],{}],"b":"x\n\"\\\u0001é","":{"c":0.1}})";
  const auto value = parse_json(text);
  ASSERT_TRUE(value);
  const std::string written = write_json(*value);
  EXPECT_EQ(written.find('\n'), std::string::npos);
  EXPECT_TRUE(equals(*value, nlohmann::ordered_json::parse(written))) << written;
}

TEST(Json, WritesNullForValuesThatJsonLacks) {
  Value::Array array;
  array.push_back({Value::Bytes{{1, 2}}});
  array.push_back({Value::TaggedValue{2}});
  array.push_back({Value::SplitOut{}});
  array.push_back({std::numeric_limits<double>::infinity()});
  array.push_back({std::numeric_limits<double>::quiet_NaN()});
  array.push_back({std::uint64_t{18446744073709551615U}});
  EXPECT_EQ(write_json({std::move(array)}), "[null,null,null,null,null,18446744073709551615]");
}

TEST(Json, KeepsTheKindOfANumber) {
  Value::Array array;
  for (const double number : {11.0, -0.0, 0.5, 1e21, 1e300}) array.push_back({number});
  array.push_back({std::int64_t{11}});
  EXPECT_EQ(write_json({std::move(array)}), "[11.0,-0.0,0.5,1e+21,1e+300,11]");
}

TEST(Value, TellsItsKindInASentence) {
  const std::vector<std::pair<Value, std::string>> kinds = {
      {{}, "null"},
      {{true}, "true or false"},
      {{std::int64_t{1}}, "a whole number"},
      {{std::uint64_t{1}}, "a whole number"},
      {{1.0}, "a number"},
      {{std::string()}, "a string"},
      {{Value::Bytes{}}, "a byte string"},
      {{Value::TaggedValue{4}}, "CBOR tag 4, which changes the meaning of its value"},
      {{Value::SplitOut{}}, "split-out bytes"},
      {{Value::Array{}}, "an array"},
      {{Value::Object{}}, "an object"}};
  for (const auto& [value, kind] : kinds) EXPECT_EQ(value.kind(), kind);
}

/// A document that cJSON alone accepts is also accepted by the splitter. Documents are made of fitting
/// pieces and then changed in one place.
TEST(Json, IsReadStrictlyOnTheFastPath) {
  std::mt19937 random(7);
  const auto below = [&random](std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
  };
  const std::vector<std::string> scalars{"0",       "-1",     "12.5",         "-0",       "1e3",
                                         "01",      "1.",     ".5",           "-",        "1.2.3",
                                         "true",    "fals",   "null",         "\"a\"",    "\"\"",
                                         "\"\\n\"", "\"\t\"", "\"\xC3\xA9\"", "\"\xFF\"", "1234567890123456",
                                         "+1",      "0x1",    "NaN"};
  const std::string bytes = std::string("{}[]\",:-0123456789.eE tfn\\\n\x01\x7F\xEF\xBB\xBF") + '\0';
  const auto document = [&](auto&& self, int depth) -> std::string {
    const std::string& scalar = scalars[below(scalars.size())];
    if (depth == 0 || below(3) == 0) return scalar;
    const std::string one = self(self, depth - 1), other = self(self, depth - 1);
    if (below(2) == 0) return icd::sentence("[", one, ", ", other, "]");
    return icd::sentence("{\"k\": ", one, ",\"\":", other, "}");
  };
  int well_formed = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string text = document(document, 3);
    if (below(2) == 0) text.insert(below(text.size() + 1), 1, bytes[below(bytes.size())]);
    if (below(4) == 0) text.erase(below(text.size()), 1);
    const auto split = decode(kJsonBody, Split::MapData, text);  // by the splitter
    ASSERT_EQ(parse_json(text).has_value(), split.has_value()) << text;
    well_formed += split ? 1 : 0;
  }
  EXPECT_GT(well_formed, 200);
  EXPECT_TRUE(parse_json("\xEF\xBB\xBF{}")) << "a byte order mark is ignored (RFC 8259 8.1)";
  EXPECT_FALSE(parse_json("{} 1"));
  EXPECT_TRUE(parse_json(std::string(64, '[') + std::string(64, ']')));
  EXPECT_FALSE(parse_json(std::string(65, '[') + std::string(65, ']')));
}

}  // namespace
}  // namespace adit::codec::test
