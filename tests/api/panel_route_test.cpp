#include "api/panel_route.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/on_page.hpp"

namespace adit::api {
namespace {

using testing::HasSubstr;

const std::vector<intake::Header> kGood = {kByToken, {"Content-Type", "application/json"}};

class PanelRouteTest : public OnPage {
 protected:
  intake::Answer post(const std::string& body, std::vector<intake::Header> headers = kGood,
                      const std::string& method = "POST") {
    return request(method, "/adit/identify", std::move(headers), body);
  }
};

TEST_F(PanelRouteTest, MakesTheLightsBlinkAndSaysUntilWhen) {
  const auto answer = post(R"({"seconds": 12.5})");
  EXPECT_EQ(answer.status, icd::Status::Ok);
  EXPECT_EQ(nlohmann::json::parse(answer.body)["identify_until"], 1012.5);
  EXPECT_EQ(judge.identified, 12.5);
}

TEST_F(PanelRouteTest, NamesTheFieldThatIsWrong) {
  for (const char* wrong : {R"({"seconds": 0})", R"({"seconds": 60.5})", R"({"seconds": -1})",
                            R"({"seconds": "10"})", R"({"seconds": null})", "{}"}) {
    const auto answer = post(wrong);
    EXPECT_EQ(answer.status, icd::Status::UnprocessableEntity) << wrong;
    EXPECT_THAT(answer.body, HasSubstr("seconds: ")) << wrong;
  }
  EXPECT_EQ(post("").status, icd::Status::BadRequest);
  EXPECT_EQ(post("seconds=10").status, icd::Status::BadRequest);
  EXPECT_EQ(post("[10]").status, icd::Status::UnprocessableEntity);
  EXPECT_EQ(post(std::string(2000, ' ')).status, icd::Status::ContentTooLarge);
  EXPECT_EQ(judge.identified, 0);
}

TEST_F(PanelRouteTest, WantsAnOperatorAndJson) {
  EXPECT_EQ(post(R"({"seconds": 10})", {}).status, icd::Status::Unauthorized);
  EXPECT_EQ(post(R"({"seconds": 10})", {kByToken}).status, icd::Status::UnprocessableEntity);
  EXPECT_EQ(post("", kGood, "GET").status, icd::Status::MethodNotAllowed);
  EXPECT_EQ(judge.identified, 0);
}

}  // namespace
}  // namespace adit::api
