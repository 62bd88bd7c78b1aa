// RFC 8259, strictly: valid and invalid documents, whole and in chunks of any size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "codec/documents.hpp"

namespace adit::codec::test {
namespace {

using namespace std::string_literals;

const std::vector<std::string> kGoodJson = {
    // Documents of every kind
    "{}", "[]", "null", "true", "false", "0", "\"\"", " \t\r\n[ ] \n", "[null,true,false]",
    "{\"a\":1,\"b\":[2,{\"c\":{}}]}", "{\"\":0}", "{\"a\":{\"a\":{\"a\":[[[]]]}}}",
    // After a byte order mark (RFC 8259 8.1)
    "\xef\xbb\xbf{}", "\xef\xbb\xbf [1]", "\xef\xbb\xbf\"a\"",
    // Numbers
    "-0", "-1", "10", "0.5", "-0.25", "1e2", "1E2", "1e+2", "1e-2", "0e1", "0E-0", "1.5e10", "123.456e-7",
    "9007199254740992", "-9007199254740993", "12345678901234567890", "1e308", "-1.7976931348623157e308",
    "4.9e-324", "1e-999", "0e999",
    "100000000000000000000000000000000000000000000000000000000000000000000000000000000000000",
    "0.000000000000000000000000000000000000000000000000000000000000000000000000000000000000012345",
    "3."
    "14159265358979323846264338327950288419716939937510582097494459230781640628620899862803482534211706",
    // Strings
    R"("\"\\\/\b\f\n\r\t")", R"("\u0041\u00e9\u20ac\uD834\uDD1E\ufffe")", R"("a\u0000b")", R"("\u0000")",
    R"("\uffff\u0000")", "\"\x7f\"", "\"\xc3\xa9\"", "\"\xe2\x82\xac\"", "\"\xf0\x9d\x84\x9e\"",
    "\"\xf4\x8f\xbf\xbf\"", "\"\xed\x9f\xbf\xee\x80\x80\"", "\"\xef\xbf\xbf\"",
    R"({"\u0061\/":"x","\u0000":1})", "\"/\"",
    // Paths that resemble msg.data
    R"({"msg":[{"data":"!"}]})", R"({"msg":{"x":{"data":"!"}}})", R"({"data":"!"})",
    R"([{"msg":{"data":"!"}}])", R"({"msg":{"datas":"!","dat":"!","data ":"!"}})", R"({"msgs":{"data":"!"}})",
    R"({"a":{"data":"!"},"msg":1})", R"({"msg":{"a":{}},"b":{"data":"!"}})", R"({"msg":{"data":null}})",
    R"({"msg":{"data":{"data":"!"}}})", R"({"msg":{"data":12}})", R"({"msg":{"data":true,"b":[1000]}})"};

TEST(JsonBody, ReadsTheSameAsAnotherParser) {
  for (const std::string& text : kGoodJson) {
    const auto expected = nlohmann::ordered_json::parse(text);
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      for (const Split split : {Split::Nothing, Split::MapData}) {
        const auto document = decode_in_chunks(kJsonBody, split, text, size);
        ASSERT_TRUE(document) << document.error().sentence;
        EXPECT_TRUE(equals(document->root, expected)) << text << " in chunks of " << size;
        EXPECT_EQ(document->data_form, DataForm::Absent);
      }
    }
  }
}

const std::vector<std::pair<std::string, std::string>> kBadJson = {
    // Empty, cut short, or followed by more
    {"", "0: an empty document"},
    {"  ", "2: the document is cut short"},
    {"{", "1: the document is cut short"},
    {"[1,", "3: the document is cut short"},
    {"\"abc", "4: the document is cut short"},
    {"\"\\u12", "5: the document is cut short"},
    {"tru", "3: the document is cut short"},
    {"1 2", "2: expected the end of the document, got '2'"},
    {"{}}", "2: expected the end of the document, got '}'"},
    {"[],", "2: expected the end of the document, got ','"},
    {"{}\0"s, "2: expected the end of the document, got byte 0x00"},
    {"\0"s, "0: expected a value, got byte 0x00 (this looks like UTF-16; expected UTF-8)"},
    {"\0{\0}"s, "0: expected a value, got byte 0x00 (this looks like UTF-16; expected UTF-8)"},
    {"{\0}\0"s, "1: expected a member's name, got byte 0x00 (this looks like UTF-16; expected UTF-8)"},
    {"\xff\xfe{\0}\0"s, "0: expected a value, got byte 0xff (this looks like UTF-16; expected UTF-8)"},
    {"\xfe\xff\0{\0}"s, "0: expected a value, got byte 0xfe (this looks like UTF-16; expected UTF-8)"},
    {"\x1f\x8b\x08",
     "0: expected a value, got byte 0x1f (this looks like gzip; expected Content-Encoding: gzip)"},
    {"\xa1\x61x\x01", "0: expected a value, got byte 0xa1 (this looks like CBOR; Content-Type says JSON)"},
    {"\xbf\xff", "0: expected a value, got byte 0xbf (this looks like CBOR; Content-Type says JSON)"},
    {"\xd9\xd9\xf7\xa0", "0: expected a value, got byte 0xd9 (this looks like CBOR; Content-Type says JSON)"},
    {"\xef\xbb\xbf", "3: the document is cut short"},
    {"\xef\xbb", "2: the document is cut short"},
    {"\xef\xbb{}", "2: expected a byte order mark, got '{'"},
    {"\xef{}", "1: expected a byte order mark, got '{'"},
    {"\xef\xbb\xbf\xef\xbb\xbf{}", "3: expected a value, got byte 0xef"},
    {" \xef\xbb\xbf{}", "1: expected a value, got byte 0xef"},
    {"{}\xef\xbb\xbf", "2: expected the end of the document, got byte 0xef"},
    {"{}\x0c", "2: expected the end of the document, got byte 0x0c"},
    {"\xa0[]", "0: expected a value, got byte 0xa0 (this looks like CBOR; Content-Type says JSON)"},
    // Structure
    {"[1}", "2: expected ',' or ']', got '}'"},
    {"{\"a\":1]", "6: expected ',' or '}', got ']'"},
    {"[1,]", "3: expected a value, got ']'"},
    {"[,1]", "1: expected a value, got ','"},
    {"[1 2]", "3: expected ',' or ']', got '2'"},
    {"]", "0: expected a value, got ']'"},
    {"{,}", "1: expected a member's name, got ','"},
    {"{\"a\":1,}", "7: expected a member's name, got '}'"},
    {"{a:1}", "1: expected a member's name, got 'a'"},
    {"{'a':1}", "1: expected a member's name, got '''"},
    {"{1:1}", "1: expected a member's name, got '1'"},
    {"{\"a\" 1}", "5: expected ':', got '1'"},
    {"{\"a\":}", "5: expected a value, got '}'"},
    {"{\"a\"::1}", "5: expected a value, got ':'"},
    {"[1]/* */", "3: expected the end of the document, got '/'"},
    {"// \n1", "0: expected a value, got '/'"},
    // Literals
    {"True", "0: expected a value, got 'T'"},
    {"nul1", "3: expected true, false or null, got '1'"},
    {"truee", "4: expected the end of the document, got 'e'"},
    {"NaN", "0: expected a value, got 'N'"},
    {"Infinity", "0: expected a value, got 'I'"},
    {"[nan]", "2: expected true, false or null, got 'a'"},
    // Numbers
    {"01", "0: a number with a leading zero"},
    {"[-01]", "1: a number with a leading zero"},
    {"-", "0: a number that is cut short"},
    {"[-]", "1: a number that is cut short"},
    {"-Infinity", "0: a number that is cut short"},
    {"+1", "0: expected a value, got '+'"},
    {".5", "0: expected a value, got '.'"},
    {"[1.]", "1: a number that is cut short"},
    {"1.e1", "0: a number that is cut short"},
    {"1e", "0: a number that is cut short"},
    {"1e+", "0: a number that is cut short"},
    {"1.5.5", "3: expected the end of the document, got '.'"},
    {"0x1F", "1: expected the end of the document, got 'x'"},
    {"1_000", "1: expected the end of the document, got '_'"},
    {"[1e999]", "1: a number too large for a double"},
    {"-1e999", "0: a number too large for a double"},
    {std::string("1").append(400, '0'), "0: a number too large for a double"},
    // Strings
    {"\"a\nb\"", "2: a raw control character in a string (byte 0x0a)"},
    {"\"\t\"", "1: a raw control character in a string (byte 0x09)"},
    {"\"\0\""s, "1: a raw control character in a string (byte 0x00)"},
    {"{\"a\x1f\":1}", "3: a raw control character in a string (byte 0x1f)"},
    {R"("\a")", "2: an escape that JSON does not have"},
    {R"("\')", "2: an escape that JSON does not have"},
    {R"("\x41")", "2: an escape that JSON does not have"},
    {R"("\U0041")", "2: an escape that JSON does not have"},
    {"\"\\\n\"", "2: an escape that JSON does not have"},
    {R"("\u00g0")", "5: an escape \\u without four hex digits"},
    {R"("\u004")", "6: an escape \\u without four hex digits"},
    {R"("\u-041")", "3: an escape \\u without four hex digits"},
    {R"("\ud800")", "7: a surrogate without its partner in a string"},
    {R"("\ud800abc")", "7: a surrogate without its partner in a string"},
    {R"("\ud800\n")", "8: a surrogate without its partner in a string"},
    {R"("\uD800\uD800")", "12: a surrogate without its partner in a string"},
    {R"("\udc00\ud800")", "6: a surrogate without its partner in a string"},
    {R"({"\uDFFF":0})", "7: a surrogate without its partner in a string"},
    // UTF-8
    {"\"\x80\"", "1: a string that is not UTF-8 (byte 0x80)"},
    {"\"\xff\"", "1: a string that is not UTF-8 (byte 0xff)"},
    {"\"\xc0\x80\"", "1: a string that is not UTF-8 (byte 0xc0)"},
    {"\"\xc3\"", "2: a string that is not UTF-8 ('\"')"},
    {"\"\xc3\\n\"", "2: a string that is not UTF-8 ('\\')"},
    {"\"\xe0\x80\x80\"", "2: a string that is not UTF-8 (byte 0x80)"},
    {"\"\xed\xa0\x80\"", "2: a string that is not UTF-8 (byte 0xa0)"},
    {"\"\xf0\x80\x80\x80\"", "2: a string that is not UTF-8 (byte 0x80)"},
    {"\"\xf4\x90\x80\x80\"", "2: a string that is not UTF-8 (byte 0x90)"},
    {"\"\xf5\x80\x80\x80\"", "1: a string that is not UTF-8 (byte 0xf5)"},
    {"{\"\xe9\":1}", "3: a string that is not UTF-8 ('\"')"},
    {"\"\xe2\x82", "3: the document is cut short"},
};

TEST(JsonBody, RejectsMalformedJsonWith400AndTheByte) {
  RecordProperty("cases", static_cast<int>(std::size(kBadJson)));  // tests/hostile/run counts them
  for (const auto& [text, why] : kBadJson) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      for (const Split split : {Split::Nothing, Split::MapData}) {
        const auto document = decode_in_chunks(kJsonBody, split, text, size);
        ASSERT_FALSE(document) << text << " in chunks of " << size;
        EXPECT_EQ(document.error().status, icd::Status::BadRequest);
        EXPECT_EQ(document.error().sentence, "not well-formed JSON at byte " + why);
      }
    }
  }
}

TEST(JsonBody, LimitsNesting) {
  for (const auto& [open, close] : {std::pair("[", "]"), std::pair("{\"a\":", "}")}) {
    std::string text = "1";
    for (int depth = 0; depth < BodyDecoder::kDeepest; ++depth)
      text = std::string(open).append(text).append(close);
    EXPECT_TRUE(decode(kJsonBody, Split::Nothing, text));
    const auto deeper = decode(kJsonBody, Split::Nothing, std::string(open).append(text).append(close));
    ASSERT_FALSE(deeper);
    EXPECT_EQ(deeper.error().status, icd::Status::BadRequest);
    EXPECT_THAT(deeper.error().sentence, testing::HasSubstr("nested deeper than 64"));
  }
  EXPECT_FALSE(decode(kJsonBody, Split::Nothing, std::string(1000000, '[')));
}

TEST(JsonBody, KeepsTheOrderAndDuplicatesOfMembers) {
  const auto document = decode(kJsonBody, Split::Nothing, R"({"b":1,"a":2,"b":3,"B":4})");
  ASSERT_TRUE(document);
  const auto& members = std::get<Value::Object>(document->root.is);
  ASSERT_EQ(members.size(), 4U);
  EXPECT_EQ(members[0].first + members[1].first + members[2].first + members[3].first, "babB");
  EXPECT_EQ(std::get<std::int64_t>(members[2].second.is), 3);
}

TEST(JsonBody, KeepsTheSignOfZero) {
  const auto document = decode(kJsonBody, Split::Nothing, "-0.0");
  ASSERT_TRUE(document);
  EXPECT_TRUE(std::signbit(std::get<double>(document->root.is)));
}

std::string quoted(std::size_t size) {
  return std::string("\"").append(size, 'x').append("\"");
}

TEST(JsonBody, RejectsABodyOverTheLimitAtOnceWith413) {
  const Limits limits{.text_bytes = 100, .data_bytes = 1000};
  EXPECT_TRUE(decode(kJsonBody, Split::Nothing, quoted(98), limits));
  for (const std::string& text : {quoted(99), std::string(101, ' '), std::string(101, '1'),
                                  std::string("[").append(101, ' ').append("]")}) {
    BodyDecoder decoder(kJsonBody, Split::Nothing, limits);
    const auto fed = decoder.feed({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    ASSERT_FALSE(fed) << text;
    EXPECT_EQ(fed.error().status, icd::Status::ContentTooLarge);
    EXPECT_EQ(decoder.finish().error(), fed.error()) << "a failed decoder repeats its error";
  }
}

}  // namespace
}  // namespace adit::codec::test
