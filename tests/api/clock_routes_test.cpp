#include <gmock/gmock.h>

#include "api/clock.hpp"
#include "api/on_page.hpp"

namespace adit::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ClockRoutesTest : public OnPage {
 protected:
  ClockRoutesTest() {
    clock.view = {
        .now = 1.8e9, .managed = true, .why = "", .source = clock::Source::LastKnown, .refusal = ""};
  }
};

TEST_F(ClockRoutesTest, ShowTheTimeOfDayAndItsSource) {
  const auto answer = get("/adit/clock");
  EXPECT_EQ(answer.status, icd::Status::Ok);
  EXPECT_THAT(answer.body, HasSubstr(R"("source":"last_known")"));
  EXPECT_THAT(answer.body, HasSubstr(R"("is_set":false)"));
}

TEST_F(ClockRoutesTest, SetThePostedTime) {
  EXPECT_EQ(post("/adit/clock", R"({"time": 1800000000.25})").status, icd::Status::Ok);
  EXPECT_THAT(clock.set, ElementsAre(1800000000.25));
}

TEST_F(ClockRoutesTest, RejectAnInvalidTimeWithTheFieldsName) {
  for (const char* body : {"{}", R"({"time": "now"})", R"({"time": null})"}) {
    const auto answer = post("/adit/clock", body);
    EXPECT_EQ(answer.status, icd::Status::UnprocessableEntity) << body;
    EXPECT_THAT(answer.body, HasSubstr("time")) << body;
  }
  EXPECT_EQ(post("/adit/clock", "soon").status, icd::Status::BadRequest);
  EXPECT_THAT(clock.set, IsEmpty());
}

TEST_F(ClockRoutesTest, TellWhyTheClockIsNotSet) {
  clock.outcome = std::unexpected(icd::Refusal{icd::Status::Conflict, "adit-clock does not run here"});
  const auto answer = post("/adit/clock", R"({"time": 1800000000})");
  EXPECT_EQ(answer.status, icd::Status::Conflict);
  EXPECT_THAT(answer.body, HasSubstr("adit-clock"));
}

}  // namespace
}  // namespace adit::api
