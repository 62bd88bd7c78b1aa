#include "api/aside_routes.hpp"

#include <gmock/gmock.h>

#include "api/on_page.hpp"

namespace adit::api {
namespace {

using testing::ElementsAre;
using testing::Pair;

const std::vector<intake::Header> kGood = {kByToken, {"Content-Type", "application/json"}};

class AsideRoutesTest : public OnPage {
 protected:
  intake::Answer post(const std::string& path, std::vector<intake::Header> headers = kGood,
                      const std::string& method = "POST") {
    return request(method, path, std::move(headers), "{}");
  }
};

TEST_F(AsideRoutesTest, PassTheOperatorsWordOn) {
  const auto sent = post("/adit/aside/7/send");
  EXPECT_EQ(sent.status, icd::Status::Ok);
  EXPECT_EQ(sent.body, R"({"aside":7})");
  EXPECT_EQ(post("/adit/aside/8/discard").status, icd::Status::Ok);
  EXPECT_THAT(judge.set_aside, ElementsAre(Pair(7, AsideAction::Send), Pair(8, AsideAction::Discard)));
}

TEST_F(AsideRoutesTest, SayWhyItIsNotDone) {
  judge.aside_trouble = "something newer was sent since";
  const auto answer = post("/adit/aside/7/send");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_EQ(answer.body, R"("something newer was sent since")");
}

TEST_F(AsideRoutesTest, WantAnOperatorAndJsonAndAPathThatIsOne) {
  EXPECT_EQ(post("/adit/aside/7/send", {}).status, icd::Status::Unauthorized);
  EXPECT_EQ(post("/adit/aside/7/send", {kByToken}).status, icd::Status::UnprocessableEntity);
  EXPECT_EQ(post("/adit/aside/7/send", kGood, "GET").status, icd::Status::MethodNotAllowed);
  for (const char* const wrong : {"/adit/aside/", "/adit/aside/7", "/adit/aside/x/send", "/adit/aside/7/hold",
                                  "/adit/aside/-1/send", "/adit/aside/7/send/more"}) {
    EXPECT_EQ(post(wrong).status, icd::Status::NotFound) << wrong;
  }
  EXPECT_TRUE(judge.set_aside.empty());
}

}  // namespace
}  // namespace adit::api
