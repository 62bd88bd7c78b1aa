#include <gtest/gtest.h>

#include "dispatch/verdicts.hpp"

namespace adit::dispatch {
namespace {

TEST(CommandPostSentence, IsTheTextOfTheBody) {
  EXPECT_EQ(answer_text(422, R"("Missing field: 'y'")"), "Missing field: 'y'");
  EXPECT_EQ(answer_text(401, R"({"detail": "Invalid token."})"), "Invalid token.");
  EXPECT_EQ(answer_text(500, "<html>"), "the Command Post answered 500");
  EXPECT_EQ(answer_text(200, "null"), "the Command Post answered 200");
}

/// Django, Flask and FastAPI name fields in different ways.
TEST(CommandPostSentence, HasTheReasonsOfARejectionInAnObject) {
  EXPECT_EQ(answer_text(422, R"({"x": ["not a number"], "y": ["missing"]})"),
            R"(the Command Post answered 422: {"x":["not a number"],"y":["missing"]})");
  EXPECT_EQ(answer_text(422, R"({"detail": [{"loc": ["y"], "msg": "missing"}]})"),
            R"(the Command Post answered 422: {"detail":[{"loc":["y"],"msg":"missing"}]})");
  EXPECT_EQ(answer_text(400, "{}"), "the Command Post answered 400");
  EXPECT_EQ(answer_text(201, R"({"id": 7})"), "the Command Post answered 201");
  EXPECT_EQ(answer_text(422, R"({"x": ")" + std::string(1000, 'x') + "\"}").size(), 303);
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
