#include "codec/json.hpp"

#include <gtest/gtest.h>

#include "codec/documents.hpp"

namespace adit::codec::test {
namespace {

TEST(Json, IsParsedOrSaidWhyNot) {
  const auto value = parse_json(R"({"a":[1,2.5,"x",null,true]})");
  ASSERT_TRUE(value);
  EXPECT_TRUE(says(*value, nlohmann::ordered_json::parse(R"({"a":[1,2.5,"x",null,true]})")));
  EXPECT_EQ(parse_json("[1,]").error(), "not well-formed JSON at byte 3: expected a value, got ']'");
  EXPECT_EQ(parse_json("nul").error(), "not well-formed JSON at byte 3: the document is cut short");
  EXPECT_EQ(parse_json("").error(), "not well-formed JSON at byte 0: an empty document");
}

TEST(Json, IsToldFromWhatIsNone) {
  for (const char* text : {"{}", " null ", "\"x\"", "1e5", "{\"msg\":{\"data\":\"!\",\"data\":1}}"}) {
    EXPECT_TRUE(is_json(text)) << text;
  }
  for (const char* text : {"", " ", "{", "<html>", "{} {}", "nul", "\"", "1e", "1e999", "{\"a\"}"}) {
    EXPECT_FALSE(is_json(text)) << text;
  }
}

TEST(Json, IsWrittenOnOneLineAndReadAgainTheSame) {
  const std::string text =
      R"({"a":[1,-2,2.5,1e+300,18446744073709551615,true,false,null,[],{}],"b":"x\n\"\\\u0001é","":{"c":0.1}})";
  const auto value = parse_json(text);
  ASSERT_TRUE(value);
  const std::string written = write_json(*value);
  EXPECT_EQ(written.find('\n'), std::string::npos);
  EXPECT_TRUE(says(*value, nlohmann::ordered_json::parse(written))) << written;
}

TEST(Json, HasNullForWhatItCannotSay) {
  Value::Array array;
  array.push_back({Value::Bytes{{1, 2}}});
  array.push_back({Value::SplitOut{}});
  array.push_back({std::numeric_limits<double>::infinity()});
  array.push_back({std::numeric_limits<double>::quiet_NaN()});
  array.push_back({std::uint64_t{18446744073709551615U}});
  EXPECT_EQ(write_json({std::move(array)}), "[null,null,null,null,18446744073709551615]");
}

TEST(Value, SaysItsKindInASentence) {
  const std::vector<std::pair<Value, std::string>> kinds = {{{}, "null"},
                                                            {{true}, "true or false"},
                                                            {{std::int64_t{1}}, "a whole number"},
                                                            {{std::uint64_t{1}}, "a whole number"},
                                                            {{1.0}, "a number"},
                                                            {{std::string()}, "a string"},
                                                            {{Value::Bytes{}}, "a byte string"},
                                                            {{Value::SplitOut{}}, "split-out bytes"},
                                                            {{Value::Array{}}, "an array"},
                                                            {{Value::Object{}}, "an object"}};
  for (const auto& [value, kind] : kinds) EXPECT_EQ(value.kind(), kind);
}

}  // namespace
}  // namespace adit::codec::test
