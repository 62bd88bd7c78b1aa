// RFC 8949: valid and invalid documents, whole and in chunks of any size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "codec/documents.hpp"
#include "codec/json.hpp"

namespace adit::codec::test {
namespace {

icd::Checked<Document> decode_hex(std::string_view hex, std::size_t size = 1000000,
                                  Split split = Split::Nothing) {
  return decode_in_chunks(kCborBody, split, from_hex(hex), size);
}

/// RFC 8949 appendix A, and the same in JSON: without tags, with null for undefined and for simple values,
/// and without members whose keys are not text.
const std::vector<std::pair<std::string, std::string>> kGoodCbor = {
    {"00", "0"},
    {"01", "1"},
    {"0a", "10"},
    {"17", "23"},
    {"1818", "24"},
    {"1819", "25"},
    {"1864", "100"},
    {"1903e8", "1000"},
    {"1a000f4240", "1000000"},
    {"1b000000e8d4a51000", "1000000000000"},
    {"1bffffffffffffffff", "18446744073709551615"},
    {"3bffffffffffffffff", "-18446744073709551616"},
    {"1b7fffffffffffffff", "9223372036854775807"},
    {"1b8000000000000000", "9223372036854775808"},
    {"3b7fffffffffffffff", "-9223372036854775808"},
    {"3b8000000000000000", "-9223372036854775809"},
    {"20", "-1"},
    {"29", "-10"},
    {"3863", "-100"},
    {"3903e7", "-1000"},
    // Lengths in a longer form than necessary are well-formed (4.1 only prefers short ones).
    {"1800", "0"},
    {"1b0000000000000001", "1"},
    {"3a00000000", "-1"},
    {"9a0000000101", "[1]"},
    {"f90000", "0.0"},
    {"f98000", "-0.0"},
    {"f93c00", "1.0"},
    {"fb3ff199999999999a", "1.1"},
    {"f93e00", "1.5"},
    {"f97bff", "65504.0"},
    {"fa47c35000", "100000.0"},
    {"fa7f7fffff", "3.4028234663852886e+38"},
    {"fb7e37e43c8800759c", "1.0e+300"},
    {"f90001", "5.960464477539063e-8"},
    {"f90400", "0.00006103515625"},
    {"f9c400", "-4.0"},
    {"fbc010666666666666", "-4.1"},
    {"f4", "false"},
    {"f5", "true"},
    {"f6", "null"},
    {"f7", "null"},
    {"f0", "null"},
    {"e0", "null"},
    {"f820", "null"},
    {"f8ff", "null"},
    {"c074323031332d30332d32315432303a30343a30305a", "\"2013-03-21T20:04:00Z\""},
    {"c11a514b67b0", "1363896240"},
    {"c1fb41d452d9ec200000", "1363896240.5"},
    {"d9d9f7 83010203", "[1,2,3]"},
    {"c0c1d7d82000", "0"},
    {"60", "\"\""},
    {"6161", "\"a\""},
    {"6449455446", "\"IETF\""},
    {"62225c", R"("\"\\")"},
    {"62c3bc", "\"\u00fc\""},
    {"63e6b0b4", "\"\u6c34\""},
    {"64f0908591", "\"\U00010151\""},
    {"80", "[]"},
    {"83010203", "[1,2,3]"},
    {"8301820203820405", "[1,[2,3],[4,5]]"},
    {"98190102030405060708090a0b0c0d0e0f101112131415161718181819",
     "[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,20,21,22,23,24,25]"},
    {"a0", "{}"},
    {"a201020304", "{}"},
    {"a26161016162820203", R"({"a":1,"b":[2,3]})"},
    {"826161a161626163", R"(["a",{"b":"c"}])"},
    {"a56161614161626142616361436164614461656145", R"({"a":"A","b":"B","c":"C","d":"D","e":"E"})"},
    {"7f657374726561646d696e67ff", "\"streaming\""},
    {"7fff", "\"\""},
    {"7f60ff", "\"\""},
    {"9fff", "[]"},
    {"9f018202039f0405ffff", "[1,[2,3],[4,5]]"},
    {"9f01820203820405ff", "[1,[2,3],[4,5]]"},
    {"83018202039f0405ff", "[1,[2,3],[4,5]]"},
    {"83019f0203ff820405", "[1,[2,3],[4,5]]"},
    {"bf61610161629f0203ffff", R"({"a":1,"b":[2,3]})"},
    {"826161bf61626163ff", R"(["a",{"b":"c"}])"},
    {"bf6346756ef563416d7421ff", R"({"Fun":true,"Amt":-2})"},
    {"bfff", "{}"},
    // Keys: chunked, tagged, text as byte strings, and keys that are not text
    {"a17f61616162ff01", R"({"ab":1})"},
    {"a1c0616101", R"({"a":1})"},
    {"a24101026161f6", "{\"\\u0001\":2,\"a\":null}"},
    {"a2 42c328 02 6161 03", R"({"a":3})"},
    {"a1 5f 4161 4162 ff 01", R"({"ab":1})"},
    {"a2 8161 61 02 6162 03", R"({"b":3})"},
    {"a2 f6 02 6162 01", R"({"b":1})"},
    {"bf a1 6161 01 02 6162 03 ff", R"({"b":3})"},
    {"a2 c2 6161 01 6162 02", R"({"b":2})"},  // under a tag that changes the meaning of a text
};

TEST(CborBody, ReadsTheExamplesOfTheRfc) {
  for (const auto& [hex, meaning] : kGoodCbor) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      for (const Split split : {Split::Nothing, Split::MapData}) {
        const auto document = decode_hex(hex, size, split);
        ASSERT_TRUE(document) << hex << ": " << document.error().sentence;
        EXPECT_TRUE(equals(document->root, nlohmann::ordered_json::parse(meaning))) << hex;
      }
    }
  }
}

/// As cbor2 writes names with string_referencing=True.
TEST(CborBody, RejectsReferencesAsNames) {
  const std::pair<std::string, std::string> cases[] = {
      {"d90100 82 a1 6478787878 01 a1 d81900 02", "25, a reference to an earlier string"},
      {"82 a1 6478787878 01 a1 d81d00 02", "29, a reference to an earlier value"}};
  for (const auto& [hex, tag] : cases) {
    for (const std::size_t size : {1, 7, 1000000}) {
      const auto document = decode_hex(hex, size, Split::Nothing);
      ASSERT_FALSE(document) << hex;
      EXPECT_EQ(document.error(), (icd::Refusal{icd::Status::UnprocessableEntity,
                                                "a member's name: expected a string, got CBOR tag " + tag +
                                                    ": switch references off in the CBOR library"}));
    }
  }
}

TEST(CborBody, KeepsByteStringsAsBytes) {
  const std::vector<std::pair<std::string, std::string>> cases = {{"40", ""},
                                                                  {"4401020304", "\1\2\3\4"},
                                                                  {"5f42010243030405ff", "\1\2\3\4\5"},
                                                                  {"5fff", ""},
                                                                  {"5f4040ff", ""},
                                                                  {"d74401020304", "\1\2\3\4"},
                                                                  {"d823456449455446", "dIETF"},
                                                                  {"c1 41 07", "\7"}};
  for (const auto& [hex, bytes] : cases) {
    const auto document = decode_hex(hex);
    ASSERT_TRUE(document) << hex;
    const auto& read = std::get<Value::Bytes>(document->root.is).bytes;
    EXPECT_EQ(std::string(read.begin(), read.end()), bytes);
  }
}

/// The value of member "a" before a member "b" with value [1].
Value before_a_list(const std::string& hex, std::size_t size, Split split) {
  const auto document = decode_hex("a2 6161" + hex + "6162 8101", size, split);
  EXPECT_TRUE(document) << hex << ": " << document.error().sentence;
  if (!document) return {};
  EXPECT_EQ(write_json(document->root), R"({"a":null,"b":[1]})") << hex;
  return std::get<Value::Object>(document->root.is).front().second;
}

TEST(CborBody, SkipsValuesUnderATagThatChangesTheMeaning) {
  for (const std::string hex :
       {"c2 410a", "c2 5f410a410bff", "c4 820102", "c4 9f8001ff", "c4 80", "c4 a1 81 00 a0",
        "c4 bf 6161 c2 4101 ff", "c4 c2 c0 01", "c4 f6", "c4 fb3ff199999999999a", "c4 7f6161ff",
        "c4 a1 636d7367 a1 6464617461 4161"}) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      for (const Split split : {Split::Nothing, Split::MapData, Split::Lists}) {
        const std::uint64_t tag = hex.starts_with("c2") ? 2 : 4;
        EXPECT_EQ(before_a_list(hex, size, split), (Value{Value::TaggedValue{tag}})) << hex;
      }
    }
  }
}

TEST(CborBody, DoesNotCountSkippedValues) {
  const Limits limits{.text_bytes = 20, .values = 3};
  const std::string body = from_hex("82 c4 98c8").append(200, '\1') + from_hex("01");
  EXPECT_TRUE(decode(kCborBody, Split::MapData, body, limits));
}

/// The head of a tag in its shortest form, before a 0.
std::string tagged(std::uint64_t tag) {
  std::string body;
  const int size = tag < 24 ? 0 : tag < 256 ? 1 : tag < 65536 ? 2 : 4;
  body += static_cast<char>(0xC0 | (size == 0 ? tag : size == 1 ? 24 : size == 2 ? 25 : 26));
  for (int byte = size - 1; byte >= 0; --byte) body += static_cast<char>(tag >> (8 * byte));
  return body + '\0';
}

/// Tags in IANA's registry whose content remains a text, a number, bytes, an array or a map.
TEST(CborBody, KeepsValuesUnderATagThatOnlyAnnotates) {
  const std::set<std::uint64_t> remarks = {0,   1,   21,  22,  23,  28,  32,   33,    34,    35,
                                           36,  39,  41,  64,  68,  72,  108,  201,   256,   258,
                                           259, 266, 267, 275, 296, 301, 1004, 21065, 22098, 55799};
  for (std::uint64_t tag = 0; tag < 70'000; ++tag) {
    const auto document = decode(kCborBody, Split::Nothing, tagged(tag));
    ASSERT_TRUE(document) << tag;
    ASSERT_EQ(document->root, remarks.contains(tag) ? Value{std::int64_t{0}} : Value{Value::TaggedValue{tag}})
        << tag;
  }
}

TEST(CborBody, KeepsNanAndInfinity) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const std::string_view hex : {"f97c00", "fa7f800000", "fb7ff0000000000000"}) {
    EXPECT_EQ(std::get<double>(decode_hex(hex)->root.is), kInfinity) << hex;
  }
  for (const std::string_view hex : {"f9fc00", "faff800000", "fbfff0000000000000"}) {
    EXPECT_EQ(std::get<double>(decode_hex(hex)->root.is), -kInfinity) << hex;
  }
  for (const std::string_view hex : {"f97e00", "fa7fc00000", "fb7ff8000000000000"}) {
    EXPECT_TRUE(std::isnan(std::get<double>(decode_hex(hex)->root.is))) << hex;
  }
}

/// RFC 8949 appendix F, and more examples of each kind.
const std::vector<std::pair<std::string, std::string>> kBadCbor = {
    {"", "0: an empty document"},
    // The document ends within a head
    {"18", "1: the document is cut short"},
    {"19", "1: the document is cut short"},
    {"1a", "1: the document is cut short"},
    {"1b", "1: the document is cut short"},
    {"1901", "2: the document is cut short"},
    {"1a0102", "3: the document is cut short"},
    {"1b01020304050607", "8: the document is cut short"},
    {"38", "1: the document is cut short"},
    {"58", "1: the document is cut short"},
    {"78", "1: the document is cut short"},
    {"98", "1: the document is cut short"},
    {"9a01ff00", "4: the document is cut short"},
    {"b8", "1: the document is cut short"},
    {"d8", "1: the document is cut short"},
    {"f8", "1: the document is cut short"},
    {"f900", "2: the document is cut short"},
    {"fa0000", "3: the document is cut short"},
    {"fb000000", "4: the document is cut short"},
    // The document ends within a definite string, also one with an impossible length
    {"41", "1: the document is cut short"},
    {"61", "1: the document is cut short"},
    {"5affffffff00", "6: the document is cut short"},
    {"5bffffffffffffffff010203", "12: the document is cut short"},
    {"7affffffff00", "6: the document is cut short"},
    {"7b7fffffffffffffff010203", "12: the document is cut short"},
    // The document ends within a definite container, also one with an impossible length
    {"81", "1: the document is cut short"},
    {"818181818181818181", "9: the document is cut short"},
    {"8200", "2: the document is cut short"},
    {"a1", "1: the document is cut short"},
    {"a20102", "3: the document is cut short"},
    {"a100", "2: the document is cut short"},
    {"a2000000", "4: the document is cut short"},
    {"9bffffffffffffffff00", "10: the document is cut short"},
    {"bbffffffffffffffff0000", "11: the document is cut short"},
    {"c0", "1: the document is cut short"},
    // The document ends within an indefinite item
    {"5f4100", "3: the document is cut short"},
    {"7f6100", "3: the document is cut short"},
    {"9f", "1: the document is cut short"},
    {"9f0102", "3: the document is cut short"},
    {"bf", "1: the document is cut short"},
    {"bf01020102", "5: the document is cut short"},
    {"819f", "2: the document is cut short"},
    {"9f8000", "3: the document is cut short"},
    {"9f9f9f9f9fffffffff", "9: the document is cut short"},
    {"9f819f819f9fffffff", "9: the document is cut short"},
    // Bytes after the document
    {"0000", "1: bytes after the document"},
    {"a000", "1: bytes after the document"},
    {"9fff00", "2: bytes after the document"},
    {"6161ff", "2: bytes after the document"},
    // Reserved additional information
    {"1c", "0: reserved additional information"},
    {"1d", "0: reserved additional information"},
    {"1e", "0: reserved additional information"},
    {"3c", "0: reserved additional information"},
    {"5d", "0: reserved additional information"},
    {"7e", "0: reserved additional information"},
    {"9c", "0: reserved additional information"},
    {"bd", "0: reserved additional information"},
    {"de", "0: reserved additional information"},
    {"fc", "0: reserved additional information"},
    {"81fd", "1: reserved additional information"},
    {"fe", "0: reserved additional information"},
    // Two-byte simple values below 32
    {"f800", "0: a simple value below 32 in two bytes"},
    {"f801", "0: a simple value below 32 in two bytes"},
    {"f818", "0: a simple value below 32 in two bytes"},
    {"81f81f", "1: a simple value below 32 in two bytes"},
    // Chunks of a wrong type in strings
    {"5f00ff", "1: a string in chunks holds something else"},
    {"5f21ff", "1: a string in chunks holds something else"},
    {"5f6100ff", "1: a string in chunks holds something else"},
    {"5f80ff", "1: a string in chunks holds something else"},
    {"5fa0ff", "1: a string in chunks holds something else"},
    {"5fc000ff", "1: a string in chunks holds something else"},
    {"5fe0ff", "1: a string in chunks holds something else"},
    {"7f4100ff", "1: a string in chunks holds something else"},
    {"5f5f4100ffff", "1: a string in chunks holds something else"},
    {"7f7f6100ffff", "1: a string in chunks holds something else"},
    // An unexpected break
    {"ff", "0: an unexpected break"},
    {"81ff", "1: an unexpected break"},
    {"8200ff", "2: an unexpected break"},
    {"a1ff", "1: an unexpected break"},
    {"a1ff00", "1: an unexpected break"},
    {"a100ff", "2: an unexpected break"},
    {"a20000ff", "3: an unexpected break"},
    {"9f81ff", "2: an unexpected break"},
    {"9f829f819f9fffffffff", "9: an unexpected break"},
    {"c0ff", "1: an unexpected break"},
    {"9fc0ff", "2: an unexpected break"},
    {"bf00ff", "2: a key without its value"},
    {"bf000000ff", "4: a key without its value"},
    // Indefinite lengths in items that allow none
    {"1f",
     "0: an indefinite length in an item that allows none (this looks like gzip; expected "
     "Content-Encoding: gzip)"},
    {"3f", "0: an indefinite length in an item that allows none"},
    {"df", "0: an indefinite length in an item that allows none"},
    // Text that is not UTF-8 (3.1), also if only a chunk is not (3.2.3)
    {"61ff", "1: a text that is not UTF-8"},
    {"62c328", "2: a text that is not UTF-8"},
    {"63eda080", "2: a text that is not UTF-8"},
    {"61c3", "0: a text that ends within a character"},
    {"7f61c361bcff", "1: a text that ends within a character"},
    {"a161ff00", "2: a text that is not UTF-8"},
    // JSON: {}, {"x": 1}, an object on several lines, an object after a byte order mark
    {"7b7d", "2: the document is cut short (this looks like JSON; Content-Type says CBOR)"},
    {"7b2278223a20317d", "8: the document is cut short (this looks like JSON; Content-Type says CBOR)"},
    {"7b2278223a20312c202279223a317d",
     "15: the document is cut short (this looks like JSON; Content-Type says CBOR)"},
    {"7b0a20202278223a20312e350a7d",
     "14: the document is cut short (this looks like JSON; Content-Type says CBOR)"},
    {"efbbbf7b7d", "1: bytes after the document (this looks like JSON; Content-Type says CBOR)"},
};

TEST(CborBody, RejectsMalformedCborWith400AndTheByte) {
  RecordProperty("cases", static_cast<int>(std::size(kBadCbor)));  // tests/hostile/run counts them
  for (const auto& [hex, why] : kBadCbor) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      for (const Split split : {Split::Nothing, Split::MapData}) {
        const auto document = decode_hex(hex, size, split);
        ASSERT_FALSE(document) << hex << " in chunks of " << size;
        EXPECT_EQ(document.error(),
                  (icd::Refusal{icd::Status::BadRequest, "not well-formed CBOR at byte " + why}))
            << hex;
      }
    }
  }
}

TEST(CborBody, LimitsNesting) {
  for (const std::string_view open : {"81", "9f", "a16161", "bf6161", "c0"}) {
    std::string hex;
    for (int depth = 0; depth < BodyDecoder::kDeepest; ++depth) hex += open;
    std::string end = "01";
    if (open == "9f" || open.starts_with("bf")) {
      for (int depth = 0; depth < BodyDecoder::kDeepest; ++depth) end += "ff";
    }
    EXPECT_TRUE(decode_hex(hex + end)) << open;
    const auto deeper = decode_hex(hex + std::string(open));
    ASSERT_FALSE(deeper) << open;
    EXPECT_EQ(deeper.error().status, icd::Status::BadRequest);
    EXPECT_THAT(deeper.error().sentence, testing::HasSubstr("nested deeper than 64"));
  }
}

TEST(CborBody, RejectsABodyOverTheLimitWith413) {
  const Limits limits{.text_bytes = 100, .data_bytes = 1000};
  const auto text_of = [](int size) {
    std::string text = "\x78";
    text += static_cast<char>(size);
    return text.append(static_cast<std::size_t>(size), 'x');
  };
  EXPECT_TRUE(decode(kCborBody, Split::MapData, text_of(98), limits));
  const auto over = decode(kCborBody, Split::MapData, text_of(99), limits);
  ASSERT_FALSE(over);
  EXPECT_EQ(over.error().status, icd::Status::ContentTooLarge);
}

}  // namespace
}  // namespace adit::codec::test
