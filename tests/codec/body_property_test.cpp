// Properties of any body: random documents from nlohmann-json, split at any byte and damaged at any byte.
#include <gtest/gtest.h>

#include <random>

#include "codec/documents.hpp"
#include "codec/json.hpp"
#include "codec/json_value.hpp"

namespace adit::codec::test {
namespace {

using nlohmann::ordered_json;
using Randomness = std::mt19937_64;

std::string random_text(Randomness& random) {
  static const std::vector<std::string> kCharacters = {
      "a",    "Z",    "0", " ",  "/", "\"",          "\\", "\n", "\t", std::string(1, '\0'),
      "\x01", "\x7f", "é", "水", "𐅑", "\xef\xbf\xbe"};
  std::string text;
  for (std::size_t left = random() % 9; left > 0; --left) text += kCharacters[random() % kCharacters.size()];
  return text;
}

double random_double(Randomness& random) {
  const double value = std::bit_cast<double>(static_cast<std::uint64_t>(random()));
  return std::isfinite(value) ? value : 0.5;
}

ordered_json random_document(Randomness& random, int depth = 0) {
  switch (random() % (depth < 5 ? 9 : 7)) {
    case 0:
      return nullptr;
    case 1:
      return random() % 2 == 0;
    case 2:
      return static_cast<std::int64_t>(random() % 2000) - 1000;
    case 3:
      return static_cast<std::int64_t>(random()) >> (11 + random() % 50);
    case 4:
      return random_double(random);
    case 5:
      return std::ldexp(static_cast<double>(random() % 1000), static_cast<int>(random() % 40) - 20);
    case 6:
      return random_text(random);
    case 7: {
      auto array = ordered_json::array();
      for (std::size_t left = random() % 5; left > 0; --left)
        array.push_back(random_document(random, depth + 1));
      return array;
    }
    default: {
      auto object = ordered_json::object();
      for (std::size_t left = random() % 5; left > 0; --left) {
        object[random_text(random)] = random_document(random, depth + 1);
      }
      return object;
    }
  }
}

std::string cbor_of(const ordered_json& document) {
  const auto bytes = ordered_json::to_cbor(document);
  return {bytes.begin(), bytes.end()};
}

std::string json_of(const ordered_json& document, Randomness& random) {
  return document.dump(static_cast<int>(random() % 4) - 1, ' ', random() % 2 == 0);
}

TEST(AnyDocument, ReadsTheSameWithAnotherParser) {
  Randomness random(1);
  for (int round = 0; round < 1000; ++round) {
    const ordered_json document = random_document(random);
    const std::string json = json_of(document, random);
    const auto from_json = decode_in_random_chunks(kJsonBody, Split::MapData, json, random);
    ASSERT_TRUE(from_json) << json << "\n" << from_json.error().sentence;
    ASSERT_TRUE(equals(from_json->root, document)) << json;
    const auto from_cbor = decode_in_random_chunks(kCborBody, Split::MapData, cbor_of(document), random);
    ASSERT_TRUE(from_cbor) << json << "\n" << from_cbor.error().sentence;
    ASSERT_TRUE(equals(from_cbor->root, document)) << json;
  }
}

TEST(AnyDocument, IsTheSameWithListsLeftAsText) {
  Randomness random(7);
  for (int round = 0; round < 1000; ++round) {
    const ordered_json document = random_document(random);
    for (const auto& [kind, body] :
         {std::pair(kJsonBody, json_of(document, random)), std::pair(kCborBody, cbor_of(document))}) {
      const auto whole = decode(kind, Split::Nothing, body);
      const auto listed = decode_in_random_chunks(kind, Split::Lists, body, random);
      ASSERT_TRUE(whole && listed) << body;
      ASSERT_EQ(write_json(whole->root), write_json(listed->root)) << body;
    }
  }
}

TEST(AnyDocument, ReadsBackTheSame) {
  Randomness random(2);
  for (int round = 0; round < 1000; ++round) {
    const ordered_json document = random_document(random);
    const auto value = parse_json(document.dump());
    ASSERT_TRUE(value);
    const std::string written = write_json(*value);
    ASSERT_TRUE(equals(*value, ordered_json::parse(written))) << written;
  }
}

/// Writes a map's data, between random members, in each of the four forms.
TEST(AnyMapData, ArrivesUnchangedInAnySizeAndForm) {
  Randomness random(3);
  const std::vector<std::size_t> sizes = {0,    1,    2,    3,    4,    5,    255,   256,   257,   4095,
                                          4096, 4097, 6143, 6144, 6145, 8191, 65535, 65536, 65537, 131'073};
  for (const std::size_t size : sizes) {
    std::vector<std::uint8_t> data(size);
    for (auto& byte : data) byte = static_cast<std::uint8_t>(random());
    const std::string base64 = base64_of(data);
    auto integers = ordered_json::array();
    for (const std::uint8_t byte : data) {
      integers.push_back(byte == 255 && random() % 2 == 0 ? -1 : static_cast<int>(byte));
    }
    const auto map_with = [&](const ordered_json& value) {
      ordered_json map;
      map["a"] = random_document(random);
      map["msg"]["b"] = random_document(random);
      map["msg"]["data"] = value;
      map["msg"]["c"] = random_document(random);
      map["d"] = random_document(random);
      return map;
    };
    const auto expect = [&](BodyKind kind, const std::string& body, DataForm form) {
      for (const bool whole : {true, false}) {
        const auto document = whole ? decode(kind, Split::MapData, body)
                                    : decode_in_random_chunks(kind, Split::MapData, body, random);
        ASSERT_TRUE(document) << size << ": " << document.error().sentence;
        EXPECT_EQ(document->data, icd::ChunkedBytes(data)) << size;
        EXPECT_EQ(document->data_form, form);
      }
    };
    expect(kJsonBody, json_of(map_with(base64), random), DataForm::Base64);
    expect(kJsonBody, json_of(map_with(integers), random), DataForm::Integers);
    expect(kCborBody, cbor_of(map_with(integers)), DataForm::Integers);
    expect(kCborBody, cbor_of(map_with(ordered_json::binary(data))), DataForm::ByteString);
  }
}

/// Changes, removes, repeats or inserts one to three bytes.
void damage(std::string& body, Randomness& random) {
  static constexpr std::string_view kTelling = "{}[]\",:\\u0eE-+./dD8 \n\t\x80\xff";
  for (std::size_t left = 1 + random() % 3; left > 0 && !body.empty(); --left) {
    const std::size_t at = random() % body.size();
    switch (random() % 4) {
      case 0:
        body[at] = static_cast<char>(body[at] ^ 1 << random() % 8);
        break;
      case 1:
        body[at] = kTelling[random() % kTelling.size()];
        break;
      case 2:
        body.erase(at, 1);
        break;
      default:
        body.insert(at, 1, kTelling[random() % kTelling.size()]);
    }
  }
}

bool ends_for_nlohmann_json(const std::string& body) {
  return body.find('\0') != std::string::npos;  // the parser takes it for the end of the document
}

TEST(AnyDamagedJson, GetsTheSameVerdictFromAnotherParser) {
  Randomness random(4);
  int accepted = 0;
  constexpr int kRounds = 10'000;
  RecordProperty("cases", kRounds);
  for (int round = 0; round < kRounds; ++round) {
    std::string body = json_of(random_document(random), random);
    damage(body, random);
    if (ends_for_nlohmann_json(body)) continue;
    const bool good = ordered_json::accept(body);
    ASSERT_EQ(parse_json(body).has_value(), good) << body;
    ASSERT_EQ(decode_in_random_chunks(kJsonBody, Split::Nothing, body, random).has_value(), good) << body;
    accepted += good ? 1 : 0;
  }
  EXPECT_GT(accepted, kRounds / 30);  // both results were common
  EXPECT_LT(accepted, kRounds - kRounds / 30);
}

/// The results of reading at once and of reading in pieces.
TEST(AnyJson, IsTheSameWithAndWithoutSplitData) {
  Randomness random(6);
  constexpr int kRounds = 6000;
  RecordProperty("cases", kRounds);
  int at_once = 0;
  for (int round = 0; round < kRounds; ++round) {
    std::string body = json_of(random_document(random), random);
    if (round % 2 == 0) damage(body, random);
    const auto whole = decode(kJsonBody, Split::Nothing, body);
    const auto split = decode_in_random_chunks(kJsonBody, Split::MapData, body, random);
    ASSERT_EQ(whole.has_value(), split.has_value()) << body;
    if (whole)
      ASSERT_EQ(write_json(whole->root), write_json(split->root)) << body;
    else
      ASSERT_EQ(whole.error(), split.error()) << body;
    const std::size_t values = random() % 20;
    const auto bounded = decode(kJsonBody, Split::Nothing, body, {.values = values});
    ASSERT_EQ(bounded.has_value(), decode(kJsonBody, Split::MapData, body, {.values = values}).has_value());
    at_once += json_value(body, values) ? 1 : 0;
  }
  EXPECT_GT(at_once, kRounds / 20);  // both ways were common
  EXPECT_LT(at_once, kRounds - kRounds / 20);
}

TEST(AnyDamagedBody, GetsTheSameVerdictInAnyPieces) {
  Randomness random(5);
  constexpr int kRounds = 6000;
  RecordProperty("cases", kRounds);
  for (int round = 0; round < kRounds; ++round) {
    ordered_json document = random_document(random);
    if (round % 2 == 0) {
      document = {{"msg",
                   {{"a", document},
                    {"data", round % 4 == 0 ? ordered_json("Zm9vYmFy") : ordered_json({0, 100, -1})}}}};
    }
    const BodyKind kind = round % 3 == 0 ? kJsonBody : kCborBody;
    std::string body = kind.format == Format::Json ? json_of(document, random) : cbor_of(document);
    damage(body, random);
    const auto whole = decode(kind, Split::MapData, body);
    const auto cut = decode_in_random_chunks(kind, Split::MapData, body, random);
    ASSERT_EQ(whole.has_value(), cut.has_value()) << body;
    if (whole) {
      EXPECT_EQ(write_json(whole->root), write_json(cut->root));
      EXPECT_EQ(whole->data, cut->data);
    } else {
      EXPECT_EQ(whole.error().sentence, cut.error().sentence) << body;
      EXPECT_EQ(whole.error().status, cut.error().status) << body;
    }
  }
}

}  // namespace
}  // namespace adit::codec::test
