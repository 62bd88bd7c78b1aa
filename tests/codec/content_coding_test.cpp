// Headers about a body's coding, and bodies that are compressed as a whole (RFC 9110 8.4.1).
#include <gtest/gtest.h>

#include <random>

#include "codec/deflated.hpp"
#include "codec/documents.hpp"

namespace adit::codec::test {
namespace {

constexpr int kGzip = 31;
constexpr int kZlib = 15;
constexpr int kRaw = -15;

TEST(BodyKind, IsReadFromHeadersInAnyCaseWithParameters) {
  for (const char* type :
       {"application/json", "Application/JSON", "application/json; charset=utf-8",
        "application/json;charset=\"UTF-8\"; x=y", " application/json ", "application/json ;"}) {
    EXPECT_EQ(format_of(type), Format::Json) << type;
  }
  EXPECT_EQ(format_of("application/CBOR"), Format::Cbor);
  EXPECT_EQ(format_of("application/cbor; charset=utf-8"), Format::Cbor);
  for (const char* type : {"", ";", "text/plain", "application/jsonp", "application/json x", "application",
                           "json", "application/x-www-form-urlencoded", "application/cbor-seq"}) {
    EXPECT_EQ(format_of(type), std::nullopt) << type;
  }
  EXPECT_EQ(coding_of(""), ContentCoding::Identity);
  EXPECT_EQ(coding_of("Identity"), ContentCoding::Identity);
  EXPECT_EQ(coding_of("gzip"), ContentCoding::Gzip);
  EXPECT_EQ(coding_of(" X-GZIP "), ContentCoding::Gzip);
  EXPECT_EQ(coding_of("Deflate"), ContentCoding::Deflate);
  for (const char* coding : {"br", "zstd", "compress", "gzip, gzip", "gzip;q=1", "gz"}) {
    EXPECT_EQ(coding_of(coding), std::nullopt) << coding;
  }
}

TEST(CompressedBody, IsInflatedAsItArrivesInEachCoding) {
  std::string json = R"({"msg":{"data":")";
  std::mt19937_64 random(3);
  for (int i = 0; i < 100000; ++i) json += "ABCDEFGH"[random() % 8];
  json += R"("}})";
  const auto plain = decode(kJsonBody, Split::MapData, json);
  ASSERT_TRUE(plain);
  for (const auto& [coding, bits] :
       {std::pair(ContentCoding::Gzip, kGzip), std::pair(ContentCoding::Deflate, kZlib),
        std::pair(ContentCoding::Deflate, kRaw)}) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      const auto document =
          decode_in_chunks({Format::Json, coding}, Split::MapData, deflated(json, bits), size);
      ASSERT_TRUE(document) << document.error().sentence;
      EXPECT_EQ(document->data, plain->data);
    }
  }
}

TEST(CompressedBody, JoinsSeveralGzipMembers) {  // RFC 1952 2.2
  const std::string nothing = deflated("", kGzip);
  const std::string body = nothing + deflated(R"({"a":)", kGzip) + nothing + nothing + deflated("1", kGzip) +
                           deflated("}", kGzip) + nothing;
  for (const std::size_t size : {1, 2, 7, 1000000}) {
    const auto document = decode_in_chunks({Format::Json, ContentCoding::Gzip}, Split::Nothing, body, size);
    ASSERT_TRUE(document) << document.error().sentence;
    EXPECT_TRUE(equals(document->root, {{"a", 1}}));
  }
}

TEST(CompressedBody, IsRejectedWith400IfDamaged) {
  const std::string good = deflated("{\"a\":1}", kGzip);
  std::string bad_sum = good;
  bad_sum[bad_sum.size() - 8] = static_cast<char>(bad_sum[bad_sum.size() - 8] ^ 1);
  std::string bad_size = good;
  bad_size.back() = static_cast<char>(bad_size.back() ^ 1);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "the body is cut short"},
      {good.substr(0, 5), "the body is cut short"},
      {good.substr(0, good.size() - 1), "the body is cut short"},
      {"{\"a\":1}", "incorrect header check"},
      {deflated("{}", kZlib), "incorrect header check"},
      {bad_sum, "incorrect data check"},
      {bad_size, "incorrect length check"}};
  RecordProperty("cases", static_cast<int>(cases.size()));  // tests/hostile/run counts them
  for (const auto& [body, why] : cases) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      const auto document = decode_in_chunks({Format::Json, ContentCoding::Gzip}, Split::Nothing, body, size);
      ASSERT_FALSE(document) << why;
      EXPECT_EQ(document.error(), (icd::Refusal{icd::Status::BadRequest, "Content-Encoding gzip: " + why}));
    }
  }
  const std::vector<std::pair<std::string, std::string>> after = {
      {"x", "the body is cut short"},
      {std::string("\0\0", 2), "incorrect header check"},
      {good.substr(0, 5), "the body is cut short"}};
  for (const auto& [more, why] : after) {
    for (const std::size_t size : {1, 2, 7, 1000000}) {
      const auto document =
          decode_in_chunks({Format::Json, ContentCoding::Gzip}, Split::Nothing, good + more, size);
      ASSERT_FALSE(document) << why;
      EXPECT_EQ(document.error(), (icd::Refusal{icd::Status::BadRequest,
                                                "Content-Encoding gzip, after a whole member: " + why}));
    }
  }
  for (const std::string& body : {std::string(), std::string("\x78"), std::string("\xff\xff"),
                                  deflated("{}", kRaw) + "x", deflated("{}", kGzip)}) {
    const auto document = decode({Format::Json, ContentCoding::Deflate}, Split::Nothing, body);
    ASSERT_FALSE(document);
    EXPECT_EQ(document.error().status, icd::Status::BadRequest);
    EXPECT_TRUE(document.error().sentence.starts_with("Content-Encoding deflate: "))
        << document.error().sentence;
  }
}

TEST(CompressedBody, RejectsABombEarlyWith413) {
  const std::string blanks = deflated(std::string().append(10'000'000, ' '), kGzip);
  const std::string data = deflated(std::string(R"({"msg":{"data":")").append(10'000'000, 'A'), kGzip);
  const Limits limits{.text_bytes = 10'000, .data_bytes = 100'000};
  std::string many;  // each member is within the limits
  for (int i = 0; i < 60; ++i) many += deflated(std::string(10'000, ' '), kGzip);
  for (const std::string& bomb : {blanks, data, many}) {
    ASSERT_LT(bomb.size(), 12'000U);
    for (const Split split : {Split::Nothing, Split::MapData}) {
      const auto document = decode({Format::Json, ContentCoding::Gzip}, split, bomb, limits);
      ASSERT_FALSE(document);
      EXPECT_EQ(document.error().status, icd::Status::ContentTooLarge);
    }
  }
}

}  // namespace
}  // namespace adit::codec::test
