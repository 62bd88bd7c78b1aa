#include <gtest/gtest.h>

#include "forward/channel.hpp"

namespace adit::forward {
namespace {

uplink::Answered answered(int status, std::string type, std::string body) {
  return {.status = status,
          .content_type = std::move(type),
          .body = std::move(body),
          .retry_after = std::nullopt};
}

TEST(ClientAnswer, HasTheBytesOfTheCommandPostIfTheyAreJson) {
  const std::string body = R"({"id": 7,  "report_status":"scored","score_change":1})";
  const intake::Answer answer = client_answer(answered(201, "application/json", body));
  EXPECT_EQ(answer.status, icd::Status::Created);
  EXPECT_EQ(answer.body, body);
  EXPECT_EQ(answer.content_type, "application/json");
}

TEST(ClientAnswer, IsAJsonStringForARejection) {  // ICD 4.1
  const auto told = [](int status, const char* body) {
    const intake::Answer answer = client_answer(answered(status, "application/json", body));
    EXPECT_EQ(static_cast<int>(answer.status), status);
    return answer.body;
  };
  EXPECT_EQ(told(401, R"({"detail": "Invalid token."})"), R"("Invalid token.")");
  EXPECT_EQ(told(400, R"( "Missing  \u0022x\u0022" )"), R"( "Missing  \u0022x\u0022" )");
  EXPECT_EQ(told(422, R"({"x": ["not a number"]})"),
            R"("the Command Post answered 422: {\"x\":[\"not a number\"]}")");
  EXPECT_EQ(told(400, "[1]"), R"("the Command Post answered 400")");
  EXPECT_EQ(told(503, "null"), R"("the Command Post answered 503")");
}

struct NotJson {
  int status;
  std::string body;
  int told;
  std::string sentence;
};

TEST(ClientAnswer, IsAJsonStringForAnyOtherBody) {
  for (const NotJson& row : {
           NotJson{404, "<h1>Not Found</h1>", 404,
                   "\"the Command Post answered 404 with a body that is not JSON\""},
           NotJson{500, "<html>oops</html>", 500,
                   "\"the Command Post answered 500 with a body that is not JSON\""},
           NotJson{501, "", 501, "\"the Command Post answered 501 with an empty body\""},
           NotJson{201, "recorded", 502, "\"the Command Post answered 201 with a body that is not JSON\""},
           NotJson{200, "{\"a\":1} trailing", 502,
                   "\"the Command Post answered 200 with a body that is not JSON\""},
       }) {
    const intake::Answer answer = client_answer(answered(row.status, "text/html", row.body));
    EXPECT_EQ(static_cast<int>(answer.status), row.told) << row.body;
    EXPECT_EQ(answer.body, row.sentence);
    EXPECT_EQ(answer.content_type, "application/json");
  }
}

}  // namespace
}  // namespace adit::forward
