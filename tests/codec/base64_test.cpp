#include "codec/base64.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace adit::codec::test {
namespace {

std::expected<std::string, std::string> decoded(std::string_view text, std::size_t run = 1000,
                                                std::size_t room = 300) {
  Base64Decoder decoder;
  std::vector<std::uint8_t> out(room);
  std::string bytes;
  const auto keep = [&](std::size_t size) {
    bytes.append(out.begin(), out.begin() + static_cast<long>(size));
  };
  while (!text.empty()) {
    std::string_view part = text.substr(0, run);
    text.remove_prefix(part.size());
    while (!part.empty()) {
      const auto size = decoder.decode(part, out);
      if (!size) return std::unexpected(size.error());
      keep(*size);
    }
  }
  std::array<std::uint8_t, 2> last{};
  const auto size = decoder.finish(last);
  if (!size) return std::unexpected(size.error());
  bytes.append(last.begin(), last.begin() + static_cast<long>(*size));
  return bytes;
}

TEST(Base64, DecodesTheVectorsOfRfc4648) {
  const std::vector<std::pair<std::string, std::string>> vectors = {{"", ""},
                                                                    {"Zg==", "f"},
                                                                    {"Zm8=", "fo"},
                                                                    {"Zm9v", "foo"},
                                                                    {"Zm9vYg==", "foob"},
                                                                    {"Zm9vYmE=", "fooba"},
                                                                    {"Zm9vYmFy", "foobar"},
                                                                    {"Zg", "f"},
                                                                    {"Zm8", "fo"},
                                                                    {"Zm9vYg", "foob"},
                                                                    {"+/+/", "\xfb\xff\xbf"}};
  for (const auto& [text, bytes] : vectors) {
    for (const std::size_t run : {1, 2, 3, 5, 1000}) {
      EXPECT_EQ(decoded(text, run), bytes) << text;
    }
  }
}

TEST(Base64, EncodesTheVectorsOfRfc4648) {
  const auto written = [](std::string_view text) {
    return codec::base64_of({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  const std::vector<std::pair<std::string, std::string>> vectors = {{"", ""},
                                                                    {"f", "Zg=="},
                                                                    {"fo", "Zm8="},
                                                                    {"foo", "Zm9v"},
                                                                    {"foob", "Zm9vYg=="},
                                                                    {"fooba", "Zm9vYmE="},
                                                                    {"foobar", "Zm9vYmFy"},
                                                                    {"\xfb\xff\xbf", "+/+/"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(written(bytes), text);
}

TEST(Base64, RejectsInvalidTextWithItsPlace) {
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"Zm9v YmFy", "character 4: a space is not in the base64 alphabet"},
      {"Zm9\n", "character 3: byte 0x0a is not in the base64 alphabet"},
      {"Zm-_", "character 2: '-' is not in the base64 alphabet"},
      {"Z", "the base64 text is cut short"},
      {"Zm9vY", "the base64 text is cut short"},
      {"Zg=", "the base64 padding is cut short"},
      {"Zg==Zg==", "character 4: unexpected character after the padding"},
      {"Zm8=A", "character 4: unexpected character after the padding"},
      {"=", "character 0: unexpected '='"},
      {"Z===", "character 1: unexpected '='"},
      {"Zm9v=", "character 4: unexpected '='"},
      {"Zm8==", "character 4: unexpected '='"},
      {"Zg===", "character 4: unexpected '='"}};
  for (const auto& [text, why] : bad) {
    for (const std::size_t run : {1, 2, 3, 5, 1000}) {
      const auto result = decoded(text, run);
      ASSERT_FALSE(result) << text;
      EXPECT_EQ(result.error(), why) << text;
    }
  }
}

TEST(Base64, DecodesTheSameInPiecesOfAnySize) {
  constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::mt19937_64 random(7);
  for (int round = 0; round < 200; ++round) {
    std::string text(4 * (random() % 50), 'A');
    for (char& c : text) c = kAlphabet[random() % kAlphabet.size()];
    const auto whole = decoded(text);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->size(), text.size() / 4 * 3);
    EXPECT_EQ(decoded(text, 1 + random() % 9, 3 + random() % 9), whole);
  }
}

}  // namespace
}  // namespace adit::codec::test
