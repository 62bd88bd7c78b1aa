#include "api/run_view.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "api/scenes.hpp"

namespace adit::api {
namespace {

using nlohmann::json;

TEST(RunView, HasNoPositionForALostReport) {
  RunView view = *scene("trouble", 1000.5, 3);
  view.reports[0].position.reset();
  const json parsed = json::parse(codec::to_json(view));
  EXPECT_EQ(parsed["reports"][0]["position"], nullptr);
  EXPECT_TRUE(parsed["reports"][1]["position"].is_object());
}

TEST(RunViewJson, WritesAbsentValuesAsNull) {
  RunView view = *scene("empty", 0, 0);
  view.activities.emplace_back();
  view.reports.emplace_back();
  const json parsed = json::parse(codec::to_json(view));
  EXPECT_TRUE(parsed.at("run").is_null());
  EXPECT_TRUE(parsed.at("run_clock").is_null());
  EXPECT_TRUE(parsed.at("endpoints")[0].at("answer_ms").is_null());
  EXPECT_TRUE(parsed.at("activities")[0].at("last_forwarded").is_null());
  EXPECT_TRUE(parsed.at("reports")[0].at("score_change").is_null());
}

TEST(RunViewJson, IsOneLineOfJsonForAnyText) {
  RunView view = *scene("hostile", 1000, 0);
  view.alarms.front().why = std::string("two\nlines\r\n\n\xc3(\0\x01\x7f\xed\xa0\x80");
  view.sent_mbit = std::numeric_limits<double>::quiet_NaN();
  const std::string text = codec::to_json(view);
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_EQ(text.find('\r'), std::string::npos);
  EXPECT_TRUE(json::accept(text));
  EXPECT_TRUE(json::parse(text)["sent_mbit"].is_null());
}

}  // namespace
}  // namespace adit::api
