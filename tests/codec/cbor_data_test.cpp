// The map's data in CBOR, split off as it arrives: a byte string (ICD 6.3) or an array of integers.
#include <gtest/gtest.h>

#include "codec/documents.hpp"

namespace adit::codec::test {
namespace {

constexpr std::string_view kMsg = "636d7367";
constexpr std::string_view kData = "6464617461";

/// {"msg": {"data": <hex>}}
std::string map_with(std::string_view hex) {
  return from_hex(std::string("a1").append(kMsg).append("a1").append(kData).append(hex));
}

struct CborCase {
  std::string body;
  std::string data;
  DataForm form = DataForm::ByteString;
};

const std::vector<CborCase> kGoodCborData = {
    {map_with("43616263"), "abc"},
    {map_with("40"), ""},
    {map_with("5f4161426263ff"), "abc"},  // in chunks
    {map_with("5fff"), ""},
    {map_with("5f40404161ff"), "a"},
    {map_with("c1d9d9f743616263"), "abc"},
    {map_with("d84043616263"), "abc"},  // RFC 8746: uint8, clamped uint8 and sint8
    {map_with("d84443616263"), "abc"},
    {map_with("d8485f43616263ff"), "abc"},
    {from_hex("a1 436d7367 a1 446461746141 61"), "a"},  // "msg" and "data" as byte strings
    {map_with("80"), "", DataForm::Integers},
    {map_with("9fff"), "", DataForm::Integers},
    {map_with("8500186420 18ff 1861"),
     std::string("\0d\xff\xff"
                 "a",
                 5),
     DataForm::Integers},
    {map_with("9f1861190062 1a00000063 1b0000000000000064ff"), "abcd", DataForm::Integers},
    {map_with("84f93c00 fa42c20000 fb4058800000000000 f9bc00"),
     "\x01"
     "ab\xff",
     DataForm::Integers},
    {map_with("82c01861c1d71862"), "ab", DataForm::Integers},
    // The path to the data: chunked keys, tags everywhere, members before and after, keys that are not text
    {from_hex("a1 7f61 6d 62 7367ff a1 7f 6464617461 60 ff 4161"), "a"},
    {from_hex("d9d9f7 a1 c0 636d7367 c1 a1 d7 6464617461 d823 4161"), "a"},
    {from_hex("bf 6161 5f4100ff 636d7367 bf 6162 9f01ff 6464617461 4161 6163 a0 ff 6164 f6 ff"), "a"},
    {from_hex("a2 a1 6464617461 00 00 636d7367 a2 81 6464617461 00 6464617461 4161"), "a"},
    {from_hex("d90103 a1 636d7367 d90113 a1 6464617461 d840 4161"), "a"},  // maps of JavaScript and of C++
    {from_hex("a2 6178 c4 a1 636d7367 a1 6464617461 4162 636d7367 a1 6464617461 4161"), "a"},
};

TEST(CborData, IsSplitOutOfTheDocumentInEachForm) {
  for (const auto& [body, data, form] : kGoodCborData) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      const auto document = decode_in_chunks(kCborBody, Split::MapData, body, size);
      ASSERT_TRUE(document) << document.error().sentence;
      EXPECT_EQ(document->data.to_string(), data);
      EXPECT_EQ(document->data_form, form);
      const Value* const mark = msg_data(document->root);
      ASSERT_NE(mark, nullptr);
      EXPECT_TRUE(std::holds_alternative<Value::SplitOut>(mark->is));
    }
  }
}

TEST(CborData, ElsewhereOrOfAnotherKindIsNotSplitOut) {
  const std::vector<std::string> bodies = {
      map_with("f6"),
      map_with("f7"),
      map_with("01"),
      map_with("f5"),
      map_with("a0"),
      map_with("a16161 4161"),
      from_hex("a1 636d7367 a1 6161 a1 6464617461 4161"),  // msg.a.data
      from_hex("a1 6464617461 4161"),
      from_hex("81 a1 636d7367 a1 6464617461 4161"),
      from_hex("a1 636d7367 81 a1 6464617461 4161"),     // msg[0].data
      from_hex("a1 636d7367 a1 a1 6464617461 4161 00"),  // in a key
      from_hex("a1 a1 636d7367 a1 6464617461 4161 00"),
      from_hex("a1 81 636d7367 a1 6464617461 4161"),  // a key that holds "msg"
  };
  for (const std::string& body : bodies) {
    const auto document = decode(kCborBody, Split::MapData, body);
    ASSERT_TRUE(document) << document.error().sentence;
    EXPECT_EQ(document->data_form, DataForm::Absent);
    EXPECT_TRUE(document->data.empty());
  }
}

TEST(CborData, OfAnotherKindIsRejectedWith422AndTheElement) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"63616263", ": expected a byte string, got a string"},
      {"7f63616263ff", ": expected a byte string, got a string"},
      {"c063616263", ": expected a byte string, got a string"},
      {"8200190100", "[1]: expected an integer from -1 to 255, got 256"},
      {"811bffffffffffffffff", "[0]: expected an integer from -1 to 255, got 18446744073709551615"},
      {"8121", "[0]: expected an integer from -1 to 255, got -2"},
      {"81f93e00", "[0]: expected an integer from -1 to 255, got 1.5"},
      {"81f97c00", "[0]: expected an integer from -1 to 255, got inf"},
      {"81f97e00", "[0]: expected an integer from -1 to 255, got nan"},
      {"9f00f6ff", "[1]: expected an integer from -1 to 255, got null"},
      {"81f5", "[0]: expected an integer from -1 to 255, got true or false"},
      {"814100", "[0]: expected an integer from -1 to 255, got a byte string"},
      {"816100", "[0]: expected an integer from -1 to 255, got a string"},
      {"8180", "[0]: expected an integer from -1 to 255, got an array"},
      {"81c0a0", "[0]: expected an integer from -1 to 255, got an object"},
      {"82 00 c24100", "[1]: expected an integer from -1 to 255, got a value under a CBOR tag"},
      {"d84542 6162",
       ": expected a byte string, got CBOR tag 69, a typed array: send plain numbers, or in msg.data its "
       "bytes"},
      {"c0d85544 00000000",
       ": expected a byte string, got CBOR tag 85, a typed array: send plain numbers, or in msg.data its "
       "bytes"}};
  for (const auto& [hex, why] : cases) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      const auto document = decode_in_chunks(kCborBody, Split::MapData, map_with(hex), size);
      ASSERT_FALSE(document) << hex;
      EXPECT_EQ(document.error(), (icd::Refusal{icd::Status::UnprocessableEntity, "msg.data" + why})) << hex;
    }
  }
}

TEST(CborData, GivenTwiceIsRejected) {
  for (const std::string_view hex :
       {"a1 636d7367 a2 6464617461 4161 6464617461 4161", "a1 636d7367 a2 6464617461 f6 6464617461 80",
        "a2 636d7367 a1 6464617461 80 636d7367 a1 6464617461 f6"}) {
    const auto document = decode(kCborBody, Split::MapData, from_hex(hex));
    ASSERT_FALSE(document) << hex;
    EXPECT_EQ(document.error(), (icd::Refusal{icd::Status::UnprocessableEntity, "msg.data: given twice"}));
  }
}

TEST(CborData, IsRejectedWith400IfMalformed) {
  for (const std::string_view hex : {"5f6161ff", "5f00ff", "5f", "42 61", "82 01", "9f01", "81ff", "81c0ff",
                                     "81f800", "811c", "9bffffffffffffffff00", "8001"}) {
    const auto document = decode(kCborBody, Split::MapData, map_with(hex));
    ASSERT_FALSE(document) << hex;
    EXPECT_EQ(document.error().status, icd::Status::BadRequest) << hex;
  }
}

TEST(CborData, HasItsOwnLimitAnsweredWith413) {
  const Limits limits{.text_bytes = 20, .data_bytes = 6000};
  const auto bytes = [](std::size_t size) {
    std::string body = map_with("59");
    body += static_cast<char>(size >> 8);
    body += static_cast<char>(size & 0xFF);
    return body.append(size, 'x');
  };
  const auto integers = [](std::size_t count) { return map_with("9f").append(count, '\x01') + "\xff"; };
  EXPECT_TRUE(decode(kCborBody, Split::MapData, bytes(6000), limits));
  EXPECT_TRUE(decode(kCborBody, Split::MapData, integers(6000), limits));
  for (const std::string& body : {bytes(6001), integers(6001)}) {
    const auto document = decode(kCborBody, Split::MapData, body, limits);
    ASSERT_FALSE(document);
    EXPECT_EQ(document.error().status, icd::Status::ContentTooLarge);
  }
}

TEST(CborData, IsRejectedByItsDeclaredLength) {
  const Limits limits{.data_bytes = 6000};
  for (const char* const hex :
       {"591771", "5b00000001ffffffff", "5bffffffffffffffff00", "5f591770 411a", "5f 591771"}) {
    const auto document = decode(kCborBody, Split::MapData, map_with(hex), limits);
    ASSERT_FALSE(document);
    const bool two = std::string_view(hex).starts_with("5f591770");  // only the first piece fits
    EXPECT_EQ(document.error().status, two ? icd::Status::BadRequest : icd::Status::ContentTooLarge) << hex;
  }
}

}  // namespace
}  // namespace adit::codec::test
