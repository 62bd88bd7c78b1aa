#include <gmock/gmock.h>

#include "api/on_page.hpp"
#include "spare/sealed.hpp"

namespace adit::api {
namespace {

using icd::Status;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class SpareRoutesTest : public OnPage {
 protected:
  intake::Answer take(const std::string& body) {
    return request("POST", "/adit/spare/take", {kByToken, {"Content-Type", "application/octet-stream"}},
                   body);
  }
};

TEST_F(SpareRoutesTest, ShowsTheStateOfTheBox) {
  spare.view.standby = true;
  spare.view.code = "1234 5678 9012 3456";
  EXPECT_THAT(get("/adit/spare").body, HasSubstr(R"("standby":true)"));
  EXPECT_THAT(get("/adit/spare").body, HasSubstr(R"("code":"1234 5678 9012 3456")"));
}

TEST_F(SpareRoutesTest, PassesOnTheOperatorsAction) {
  for (const char* const path : {"standby", "resume", "forget"})
    EXPECT_EQ(post(std::string("/adit/spare/") + path).status, Status::Ok) << path;
  EXPECT_EQ(post("/adit/spare/open", R"({"code":"1234"})").status, Status::Ok);
  EXPECT_THAT(spare.asked, ElementsAre("standby", "resume", "forget", "open 1234"));
  spare.outcome = std::unexpected(icd::Refusal{Status::Conflict, "it does not rest"});
  const auto refused = post("/adit/spare/resume");
  EXPECT_EQ(refused.status, Status::Conflict);
  EXPECT_EQ(refused.body, "\"it does not rest\"");
}

TEST_F(SpareRoutesTest, TakesOverOnlyIfTheFirstBoxIsUnplugged) {
  for (const char* const body : {"{}", R"({"unplugged":false})", R"({"unplugged":0})", "[]", "x"})
    EXPECT_NE(post("/adit/spare/take-over", body).status, Status::Ok) << body;
  EXPECT_THAT(spare.asked, IsEmpty());
  EXPECT_EQ(post("/adit/spare/take-over", R"({"unplugged":true})").status, Status::Ok);
  EXPECT_THAT(spare.asked, ElementsAre("take over"));
}

TEST_F(SpareRoutesTest, GivesTheExportAsAFile) {
  const auto answer = get("/adit/spare/export");
  EXPECT_EQ(answer.body, "a sealed file");
  EXPECT_EQ(answer.content_type, "application/octet-stream");
}

TEST_F(SpareRoutesTest, ListsTheStick) {
  EXPECT_THAT(get("/adit/spare").body, HasSubstr(R"("stick":null)"));
  spare.view.stick = StickRow{.hindrance = "",
                              .unreadable = "",
                              .doing = "",
                              .refusal = "",
                              .written = "",
                              .exports = {{.name = "a.adit-spare", .box = "10.0.0.1", .at = 1.75e9}}};
  EXPECT_THAT(get("/adit/spare").body, HasSubstr(R"("box":"10.0.0.1")"));
}

TEST_F(SpareRoutesTest, WritesAndReadsExportsOnTheStick) {
  EXPECT_EQ(post("/adit/spare/to-stick").status, Status::Ok);
  EXPECT_EQ(post("/adit/spare/from-stick", R"({"name":"a.adit-spare"})").status, Status::Ok);
  EXPECT_THAT(spare.asked, ElementsAre("export to the stick", "take a.adit-spare"));
  for (const char* const body : {"{}", R"({"name":7})", "[]", "x"})
    EXPECT_NE(post("/adit/spare/from-stick", body).status, Status::Ok) << body;
  spare.outcome = std::unexpected(icd::Refusal{Status::Conflict, "there is no stick in the box"});
  EXPECT_EQ(post("/adit/spare/to-stick").status, Status::Conflict);
  EXPECT_EQ(spare.asked.size(), 3U);
}

TEST_F(SpareRoutesTest, RejectsOtherFilesByTheirFirstBytes) {
  const std::string whole = std::string("adit-spare\1\0", 12) + std::string(1000, 'x');
  EXPECT_EQ(take(whole).status, Status::Ok);
  EXPECT_EQ(spare.file, whole);
  const auto none = take("PK\3\4 a zip file");
  EXPECT_EQ(none.status, Status::UnprocessableEntity);
  EXPECT_THAT(none.body, HasSubstr("the file is not an export from Adit"));
  EXPECT_EQ(take("").status, Status::UnprocessableEntity);
  EXPECT_EQ(spare.file, whole);
}

TEST_F(SpareRoutesTest, RejectsAnExportThatIsTooLarge) {
  const auto sink = open("POST", "/adit/spare/take", {kByToken, {"Content-Type", "application/octet-stream"}},
                         spare::kLargestExport + 1);
  EXPECT_EQ(sink, nullptr);
  EXPECT_EQ(responder->answered->status, Status::ContentTooLarge);
}

}  // namespace
}  // namespace adit::api
