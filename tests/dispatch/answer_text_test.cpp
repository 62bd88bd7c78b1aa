#include "dispatch/answer_text.hpp"

#include <gtest/gtest.h>

namespace adit::dispatch {
namespace {

TEST(CommandPostSentence, IsTheTextOfTheBody) {
  EXPECT_EQ(answer_text(422, R"("Missing field: 'y'")"), "Missing field: 'y'");
  EXPECT_EQ(answer_text(401, R"({"detail": "Invalid token."})"), "Invalid token.");
  EXPECT_EQ(answer_text(500, "<html>"), "the Command Post answered 500");
  EXPECT_EQ(answer_text(200, "null"), "the Command Post answered 200");
}

TEST(CommandPostSentence, IsCutBetweenCharacters) {
  std::string text = "x";
  for (int i = 0; i < 400; ++i) text += "\xC3\xA9";
  const std::string sentence = answer_text(422, "\"" + text + "\"");
  EXPECT_EQ(sentence.size(), 299 + 3);
  EXPECT_EQ(sentence.substr(sentence.size() - 5), "\xC3\xA9...");
}

}  // namespace
}  // namespace adit::dispatch
