#include <gmock/gmock.h>

#include "api/map_routes.hpp"
#include "api/on_page.hpp"

namespace adit::api {
namespace {

using testing::HasSubstr;
using testing::Not;

class KeptRunsRoutesTest : public OnPage {
 protected:
  KeptRunsRoutesTest() {
    runs.all.runs = {{.key = "3", .run = 3, .course = "alpha"}, {.key = "2", .run = 2, .is_present = true}};
    runs.kept = std::make_shared<KeptRun>(
        KeptRun{runs.all.runs[0], picture::Mosaic(), {{"ugv1", {{.at = 5, .position = {}}}}}, {}});
  }
};

TEST_F(KeptRunsRoutesTest, ListRunsAndShowOne) {
  EXPECT_THAT(get("/adit/runs").body, HasSubstr("\"course\":\"alpha\""));
  EXPECT_THAT(get("/adit/runs/3").body, HasSubstr("\"key\":\"3\""));
  EXPECT_THAT(get("/adit/runs/3/tracks").body, HasSubstr("ugv1"));
  EXPECT_THAT(get("/adit/runs/3/map").body, HasSubstr("\"layers\":[]"));
  EXPECT_THAT(get("/adit/runs/3/history").body, HasSubstr("\"at\":[]"));
}

TEST_F(KeptRunsRoutesTest, RejectAnUnknownRun) {
  for (const char* path : {"/adit/runs/9", "/adit/runs/9/map", "/adit/runs/9/tracks", "/adit/runs/9/history",
                           "/adit/runs/9/report.html", "/adit/runs/3/map/grid/a/0/0/0.png"})
    EXPECT_EQ(get(path).status, icd::Status::NotFound) << path;
  EXPECT_EQ(get("/adit/runs/3/map?since=x").status, icd::Status::BadRequest);
}

TEST_F(KeptRunsRoutesTest, DoNotCallAnUnreadableRunAbsent) {
  runs.unreadable = "cannot read the stored run: runs/3: Input/output error";
  for (const char* path : {"/adit/runs/3/map", "/adit/runs/3/tracks", "/adit/runs/3/report.html"}) {
    EXPECT_EQ(get(path).status, icd::Status::ServiceUnavailable) << path;
    EXPECT_THAT(get(path).body, HasSubstr("Input/output error")) << path;
  }
  runs.all.unreadable = "cannot list stored runs";
  EXPECT_EQ(get("/adit/runs/9").status, icd::Status::ServiceUnavailable);
}

TEST_F(KeptRunsRoutesTest, PrintOnlyTheReportsOfThatRun) {
  source.details[1].row.number = 1;
  source.details[1].row.run = 3;
  source.details[2].row.number = 2;
  source.details[2].row.run = 2;
  const auto answer = get("/adit/runs/3/report.html");
  EXPECT_EQ(answer.content_type, "text/html; charset=utf-8");
  ASSERT_EQ(runs.reported.size(), 1U);
  EXPECT_EQ(runs.reported[0].row.number, 1);
  const auto policy = std::ranges::find(answer.headers, "Content-Security-Policy", &intake::Header::name);
  ASSERT_NE(policy, answer.headers.end());
  EXPECT_THAT(policy->value, Not(HasSubstr("script")));
}

TEST_F(KeptRunsRoutesTest, DeleteARun) {
  EXPECT_EQ(post("/adit/runs/3/delete").status, icd::Status::Ok);
  EXPECT_EQ(post("/adit/runs/3/delete").status, icd::Status::NotFound);
}

}  // namespace
}  // namespace adit::api
