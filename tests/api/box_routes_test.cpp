#include "api/box_routes.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "api/on_page.hpp"
#include "codec/gzip.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using Status = icd::Status;

class BoxRoutesTest : public OnPage {
 protected:
  BoxRoutesTest() {
    box.say(5, "notice", "listening");
    box.say(4, "warning", "the Command Post refused a state", "too fast");
    box.say(6, "info", "refused");
    box.say(3, "error", "the ledger cannot be written");
  }
  std::vector<std::string> log(const std::string& query) {
    std::vector<std::string> messages;
    const json said = json::parse(get("/adit/log" + query).body);
    for (const json& record : said["records"]) messages.push_back(record["message"]);
    return messages;
  }
};

TEST_F(BoxRoutesTest, ShowTheLogOldestFirst) {
  const json said = json::parse(get("/adit/log").body);
  EXPECT_EQ(said["last"], 4);
  EXPECT_EQ(said["records"][1], (json{{"seq", 2},
                                      {"at", 1'780'000'002.0},
                                      {"level", "warning"},
                                      {"message", "the Command Post refused a state"},
                                      {"fields", {{"note", "too fast"}}}}));
  EXPECT_THAT(log(""), ElementsAre("listening", "the Command Post refused a state", "refused",
                                   "the ledger cannot be written"));
}

TEST_F(BoxRoutesTest, FilterTheLog) {
  EXPECT_THAT(log("?level=error"), ElementsAre("the ledger cannot be written"));
  EXPECT_THAT(log("?level=warning"),
              ElementsAre("the Command Post refused a state", "the ledger cannot be written"));
  EXPECT_THAT(log("?text=REFUSED"), ElementsAre("the Command Post refused a state", "refused"));
  EXPECT_THAT(log("?text=too fast"), ElementsAre("the Command Post refused a state")) << "in a field";
  EXPECT_THAT(log("?since=3"), ElementsAre("the ledger cannot be written"));
  EXPECT_THAT(log("?since=1&level=info&text=fused"),
              ElementsAre("the Command Post refused a state", "refused"));
  EXPECT_THAT(log("?since=99"), IsEmpty());
  EXPECT_EQ(json::parse(get("/adit/log?since=99").body)["last"], 4) << "the box was restarted";
}

TEST_F(BoxRoutesTest, NameTheFaultOfAFilter) {
  EXPECT_EQ(get("/adit/log?level=loud").status, Status::BadRequest);
  EXPECT_THAT(get("/adit/log?level=loud").body, HasSubstr("level: expected error, warning"));
  for (const char* since : {"x", "-1", "1.5", "18446744073709551616"}) {
    EXPECT_EQ(get(std::string("/adit/log?since=") + since).status, Status::BadRequest) << since;
    EXPECT_EQ(get(std::string("/adit/log.txt?since=") + since).status, Status::BadRequest) << since;
  }
}

TEST_F(BoxRoutesTest, GiveTheLogAsAFile) {
  const auto answer = get("/adit/log.txt?level=warning");
  EXPECT_EQ(answer.body,
            "warning: the Command Post refused a state note=too fast\nerror: the ledger cannot be written\n");
  EXPECT_EQ(header(answer, "Content-Disposition"), "attachment; filename=\"adit-log.txt\"");
  EXPECT_EQ(answer.content_type, "text/plain; charset=utf-8");
}

TEST_F(BoxRoutesTest, ShowThePartsOfTheBox) {
  box.self.started = loop.wall_now() - 60;
  box.self.kernel = "Linux 6.1.0 aarch64";
  box.self.parts = {{.name = "zlib", .version = "1.2.13", .licence = "Zlib"}};
  const json said = json::parse(get("/adit/about").body);
  EXPECT_EQ(said["version"], "0.1.0");
  EXPECT_NEAR(said["uptime"], 60, 5);
  EXPECT_EQ(said["board"], nullptr);
  box.self.board = {"qemu-virt", "QEMU's virt machine"};
  EXPECT_EQ(json::parse(get("/adit/about").body)["board"],
            (json{{"name", "qemu-virt"}, {"title", "QEMU's virt machine"}}));
  EXPECT_EQ(said["parts"], (json{{{"name", "zlib"}, {"version", "1.2.13"}, {"licence", "Zlib"}}}));
}

TEST_F(BoxRoutesTest, CountTheSessionsInTheMetrics) {
  request("POST", "/adit/login", {{"Content-Type", "application/json"}},
          R"({"password":"look, do not touch"})");
  EXPECT_THAT(get("/metrics").body, HasSubstr("adit_sessions{role=\"viewer\"} 1\n"));
}

TEST_F(BoxRoutesTest, PackADiagnosticBundle) {
  const auto answer = get("/adit/bundle");
  ASSERT_EQ(answer.status, Status::Ok);
  EXPECT_EQ(answer.content_type, "application/gzip");
  EXPECT_THAT(header(answer, "Content-Disposition"), StartsWith("attachment; filename=\"adit-support-20"));
  std::string archive;
  const auto bytes = std::span(reinterpret_cast<const std::uint8_t*>(answer.body.data()), answer.body.size());
  ASSERT_TRUE(codec::gunzip(icd::ChunkedBytes(bytes), 1u << 24, "", [&](std::span<const std::uint8_t> piece) {
    archive.append(piece.begin(), piece.end());
    return icd::Checked<void>{};
  }));
  for (const char* name : {"about.json", "run.json", "reports.json", "settings.json", "network.json",
                           "metrics.txt", "log.txt"}) {
    EXPECT_THAT(archive, HasSubstr(std::string("/") + name));
  }
  EXPECT_THAT(archive, HasSubstr(R"({"version":1})"));
  EXPECT_THAT(archive, HasSubstr("the ledger cannot be written"));
  EXPECT_THAT(archive, HasSubstr("adit_build_info"));
  for (const char* secret : {"team-1", "correct horse", "look, do not touch"})
    EXPECT_THAT(archive, Not(HasSubstr(secret)));
}

}  // namespace
}  // namespace adit::api
