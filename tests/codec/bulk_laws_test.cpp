// Laws of a map's data in JSON, which has a fast way and a slow one: byte by byte it goes the slow way alone,
// in larger pieces both, and what it is must not depend on that. Hostile and good data alike.
#include <gtest/gtest.h>

#include <random>

#include "codec/base64.hpp"
#include "codec/documents.hpp"
#include "codec/plain_elements.hpp"

namespace adit::codec::test {
namespace {

using Randomness = std::mt19937_64;

template <class Choices>
auto one_of(const Choices& choices, Randomness& random) {
  return choices[random() % std::size(choices)];
}

/// A string of base64 with its quotation marks: seldom longer than a block that is looked at at once, some of
/// it escaped, every second damaged.
std::string random_base64(Randomness& random) {
  const std::vector<std::string> odd = {"=",  "==",   "\\/",  "\\u0041", "\\u002b", "\\u00", "\\n",
                                        "\\", "\"",   "\"}",  "-",       "_",       " ",     "\n",
                                        "é",  "\xff", "\x80", "\\uD83D", "\\u003d", "A=",    "\x01"};
  std::string text;
  for (std::size_t left = random() % (random() % 8 == 0 ? 9000 : 120); left > 0; --left) {
    text += one_of(kBase64, random);
  }
  const bool damaged = random() % 2 == 0;
  for (std::size_t left = damaged ? 1 + random() % 3 : 0; left > 0; --left) {
    text.insert(text.size() - std::min(text.size(), random() % (text.size() + 2)), one_of(odd, random));
  }
  return '"' + text + '"';
}

/// A list: runs of the same element, in one of the ways in which clients write them, every second damaged.
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
    for (std::size_t left = 1 + random() % (random() % 16 == 0 ? 5000 : 12); left > 0; --left)
      text += same + comma;
  }
  text += element() + ']';
  const bool damaged = random() % 2 == 0;
  for (std::size_t left = damaged ? 1 + random() % 2 : 0; left > 0; --left) {
    text.insert(random() % (text.size() + 1), one_of(odd, random));
  }
  return text;
}

/// Gives how many of the bodies were good.
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

TEST(AnyBase64, IsTheSameByTheFastWayAndByTheSlowOne) {
  Randomness random(11);
  const int good = expect_the_same_however_cut(6000, random, random_base64);
  EXPECT_GT(good, 600);  // both verdicts were common enough to mean something
  EXPECT_LT(good, 5400);
}

TEST(AnyList, IsTheSameByTheFastWayAndByTheSlowOne) {
  Randomness random(12);
  const int good = expect_the_same_however_cut(2000, random, random_list);
  EXPECT_GT(good, 200);
  EXPECT_LT(good, 1800);
}

/// The bytes of base64 as RFC 4648 has it, one character at a time.
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

TEST(WholeGroups, AreDecodedUpToTheFirstThatIsNoneAndAsFarAsThereIsRoom) {
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

TEST(WholeGroups, AreNoneWithinAGroup) {
  Base64Decoder decoder;
  std::array<std::uint8_t, 100> out{};
  std::string_view first = "Zm";
  EXPECT_EQ(decoder.decode(first, out), 0u);
  EXPECT_EQ(decoder.missing(), 2u);
  std::string_view more = "9vZm9v";
  EXPECT_EQ(decoder.decode_groups(more, out), 0u);
  EXPECT_EQ(more.size(), 6u);
}

TEST(PlainElements, AreTakenWithTheirCommaAndAsManyAsAreTheSame) {
  struct Case {
    std::string_view text;
    int value;  // -1: nothing is taken
    std::size_t count;
    std::string_view rest;
  };
  const std::vector<Case> cases = {
      {"0,", 0, 1, ""},
      {"-1, -1, -1, 0", 255, 1, " -1, -1, 0"},
      {" -1, -1, -1, 0", 255, 3, " 0"},
      {"7,7,7,71,", 7, 3, "71,"},
      {"255 ,255 ,25", 255, 2, "25"},
      {"100\n,\n", 100, 1, "\n"},
      {"12,12,12", 12, 2, "12"},
      {"0", -1, 0, ""},
      {"0]", -1, 0, ""},
      {"00,", -1, 0, ""},
      {"01,", -1, 0, ""},
      {"256,", -1, 0, ""},
      {"1000,", -1, 0, ""},
      {"-2,", -1, 0, ""},
      {"-10,", -1, 0, ""},
      {"-1", -1, 0, ""},
      {"-0,", -1, 0, ""},
      {"1.0,", -1, 0, ""},
      {"1e1,", -1, 0, ""},
      {",", -1, 0, ""},
      {"", -1, 0, ""},
      {"  ", -1, 0, ""},
      {"\f1,", -1, 0, ""},
  };
  for (const Case& row : cases) {
    std::string_view text = row.text;
    const auto taken = take_plain_elements(text);
    ASSERT_EQ(taken.has_value(), row.value >= 0) << row.text;
    EXPECT_EQ(text, taken ? row.rest : row.text);
    if (!taken) continue;
    EXPECT_EQ(int{taken->value}, row.value) << row.text;
    EXPECT_EQ(taken->count, row.count) << row.text;
  }
}

}  // namespace
}  // namespace adit::codec::test
