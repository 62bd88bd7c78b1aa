// Properties of a map's data in JSON, which has a fast and a slow parser. Single bytes use only the slow
// one, larger pieces use both. The result must not depend on that, for valid and for damaged data.
#include <gtest/gtest.h>

#include <random>

#include "codec/base64.hpp"
#include "codec/documents.hpp"

namespace adit::codec::test {
namespace {

using Randomness = std::mt19937_64;

template <class Choices>
auto one_of(const Choices& choices, Randomness& random) {
  return choices[random() % std::size(choices)];
}

/// A JSON string of base64, rarely longer than a block of the fast parser. Some characters are escaped,
/// every second string is damaged.
std::string random_base64(Randomness& random) {
  const std::vector<std::string> odd = {"=",  "==",   "\\/",  "\\u0041", "\\u002b", "\\u00", "\\n",
                                        "\\", "\"",   "\"}",  "-",       "_",       " ",     "\n",
                                        "é",  "\xff", "\x80", "\\uD83D", "\\u003d", "A=",    "\x01"};
  std::string text;
  for (std::size_t left = random() % (random() % 8 == 0 ? 4000 : 120); left > 0; --left) {
    text += one_of(kBase64, random);
  }
  const bool damaged = random() % 2 == 0;
  for (std::size_t left = damaged ? 1 + random() % 3 : 0; left > 0; --left) {
    text.insert(text.size() - std::min(text.size(), random() % (text.size() + 2)), one_of(odd, random));
  }
  return '"' + text + '"';
}

/// A list with runs of the same element, in a style of some client. Every second list is damaged.
std::string random_list(Randomness& random) {
  const std::vector<std::string> between = {",", ", ", ",\n    ", " , ", " ,", ",\t\r"};
  const std::vector<std::string> odd = {"256",  "-2",   "1.0",   "01",   "-0",  "1e1", "00",  "-",
                                        "",     "1 2",  "\"1\"", "[",    "]",   "{}",  "999", "1.5",
                                        "null", "-1-1", "-10",   "1000", "tru", ",",   "\f",  "0x1"};
  const std::string comma = one_of(between, random);
  const auto element = [&] { return std::to_string(random() % 4 == 0 ? random() % 256 : random() % 3 * 50); };
  std::string text = random() % 4 == 0 ? "[ " : "[";
  for (std::size_t runs = random() % 20; runs > 0; --runs) {
    const std::string same = random() % 3 == 0 ? "-1" : element();
    for (std::size_t left = 1 + random() % (random() % 16 == 0 ? 1500 : 12); left > 0; --left)
      text += same + comma;
  }
  text += element() + ']';
  const bool damaged = random() % 2 == 0;
  for (std::size_t left = damaged ? 1 + random() % 2 : 0; left > 0; --left) {
    text.insert(random() % (text.size() + 1), one_of(odd, random));
  }
  return text;
}

/// Returns how many bodies were valid.
int expect_the_same_however_cut(int rounds, Randomness& random, std::string (*data)(Randomness&)) {
  int good = 0;
  ::testing::Test::RecordProperty("cases", rounds);
  for (int round = 0; round < rounds; ++round) {
    const Limits limits{.data_bytes = round % 4 == 0 ? random() % 300 : std::size_t{1} << 20};
    const std::string body = R"({"msg":{"a":[1],"data":)" + data(random) + R"(,"b":"c"}})";
    const auto slow = decode_in_chunks(kJsonBody, Split::MapData, body, 1, limits);
    for (const auto& fast : {decode(kJsonBody, Split::MapData, body, limits),
                             decode_in_random_chunks(kJsonBody, Split::MapData, body, random, 300, limits)}) {
      EXPECT_EQ(slow.has_value(), fast.has_value()) << body;
      if (!slow && !fast) {
        EXPECT_EQ(slow.error().sentence, fast.error().sentence) << body;
        EXPECT_EQ(slow.error().status, fast.error().status) << body;
      }
      if (slow && fast) {
        EXPECT_EQ(slow->data, fast->data) << body;
        EXPECT_EQ(slow->data_form, fast->data_form) << body;
      }
      if (::testing::Test::HasFailure()) return -1;
    }
    good += slow ? 1 : 0;
  }
  return good;
}

TEST(AnyBase64, DecodesTheSameOnTheFastAndSlowPath) {
  Randomness random(11);
  const int good = expect_the_same_however_cut(2000, random, random_base64);
  EXPECT_GT(good, 200);  // both results were common
  EXPECT_LT(good, 1800);
}

TEST(AnyList, ReadsTheSameOnTheFastAndSlowPath) {
  Randomness random(12);
  const int good = expect_the_same_however_cut(700, random, random_list);
  EXPECT_GT(good, 70);
  EXPECT_LT(good, 630);
}

/// Decodes base64 by RFC 4648, one character at a time.
std::vector<std::uint8_t> bytes_of(std::string_view base64) {
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < base64.size(); ++i) {
    bits = bits << 6 | static_cast<std::uint32_t>(kBase64.find(base64[i]));
    if (i % 4 == 3) {
      for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
    }
  }
  return bytes;
}

/// A CBOR list of runs, with a length or a break, with some elements in a longer form than necessary. And
/// its bytes.
struct CborList {
  std::string body = from_hex("a1 63 6d7367 a1 64 64617461");
  icd::ChunkedBytes bytes;
};

CborList random_cbor_list(Randomness& random) {
  CborList list;
  std::string elements;
  std::size_t count = 0;
  for (std::size_t runs = random() % 12; runs > 0; --runs) {
    const auto value = static_cast<std::uint8_t>(random() % 3 == 0 ? 255 : random() % 256);
    std::string element(1, static_cast<char>(value));
    if (value >= 24 || random() % 8 == 0) element.insert(0, 1, '\x18');
    if (value == 255 && random() % 2 == 0) element = random() % 4 == 0 ? from_hex("3800") : from_hex("20");
    if (random() % 10 == 0) element = from_hex("c1 1900") + static_cast<char>(value);  // with a tag
    for (std::size_t left = 1 + random() % (random() % 16 == 0 ? 2000 : 9); left > 0; --left, ++count) {
      elements += element;
      list.bytes.append(std::array{value});
    }
  }
  if (random() % 2 == 0) {
    list.body += '\x9f' + elements + '\xff';
  } else {
    list.body += '\x9a';
    for (const int shift : {24, 16, 8, 0}) list.body += static_cast<char>(count >> shift & 255);
    list.body += elements;
  }
  return list;
}

TEST(AnyCborList, ReadsTheSameInAnyPieces) {
  Randomness random(14);
  for (int round = 0; round < 500; ++round) {
    const CborList list = random_cbor_list(random);
    for (const auto& document :
         {decode(kCborBody, Split::MapData, list.body),
          decode_in_chunks(kCborBody, Split::MapData, list.body, 1),
          decode_in_random_chunks(kCborBody, Split::MapData, list.body, random, 300)}) {
      ASSERT_TRUE(document) << document.error().sentence;
      ASSERT_EQ(document->data, list.bytes);
    }
  }
}

TEST(AnyCborList, DamagedGetsTheSameVerdictInAnyPieces) {
  Randomness random(15);
  int good = 0;
  constexpr int kRounds = 1000;
  for (int round = 0; round < kRounds; ++round) {
    std::string body = random_cbor_list(random).body;
    for (std::size_t left = 1 + random() % 2; left > 0; --left) {
      const std::size_t at = random() % body.size();
      body[at] = static_cast<char>(random() % 2 == 0 ? random() : "\x18\x19\x20\x9f\xff\xf6"[random() % 6]);
    }
    const Limits limits{.data_bytes = round % 4 == 0 ? random() % 300 : std::size_t{1} << 20};
    const auto bytewise = decode_in_chunks(kCborBody, Split::MapData, body, 1, limits);
    for (const auto& document :
         {decode(kCborBody, Split::MapData, body, limits),
          decode_in_random_chunks(kCborBody, Split::MapData, body, random, 300, limits)}) {
      ASSERT_EQ(bytewise.has_value(), document.has_value());
      if (document) {
        ASSERT_EQ(bytewise->data, document->data);
      } else {
        ASSERT_EQ(bytewise.error(), document.error());
      }
    }
    good += bytewise ? 1 : 0;
  }
  EXPECT_GT(good, kRounds / 20);
  EXPECT_LT(good, kRounds - kRounds / 20);
}

TEST(WholeGroups, AreDecodedUntilAnInvalidOneOrAFullBuffer) {
  Randomness random(13);
  for (int round = 0; round < 3000; ++round) {
    std::string text(4 * (random() % 60), 'A');
    for (char& c : text) c = one_of(kBase64, random);
    const std::size_t stop = random() % (text.size() + 1);
    const std::string all =
        text.substr(0, stop) + one_of(std::string_view("\"\\=-\x80\xff\n"), random) + text;
    std::vector<std::uint8_t> out(random() % 200);
    std::string_view run = all;
    Base64Decoder decoder;
    const std::size_t size = decoder.decode_groups(run, out);
    const std::size_t groups = std::min(stop / 4, out.empty() ? 0 : (out.size() - 1) / 3);
    ASSERT_EQ(size, 3 * groups) << all << " into " << out.size();
    ASSERT_EQ(run.size(), all.size() - 4 * groups);
    out.resize(size);
    ASSERT_EQ(out, bytes_of(std::string_view(all).substr(0, 4 * groups)));
  }
}

TEST(WholeGroups, AreNotFoundInsideAGroup) {
  Base64Decoder decoder;
  std::array<std::uint8_t, 100> out{};
  std::string_view first = "Zm";
  EXPECT_EQ(decoder.decode(first, out), 0u);
  EXPECT_EQ(decoder.missing(), 2u);
  std::string_view more = "9vZm9v";
  EXPECT_EQ(decoder.decode_groups(more, out), 0u);
  EXPECT_EQ(more.size(), 6u);
}

}  // namespace
}  // namespace adit::codec::test
