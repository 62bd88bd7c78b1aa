#include "api/api.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "api/on_page.hpp"
#include "api/scenes.hpp"
#include "icd/artifact_report.hpp"
#include "intake/raw_client.hpp"
#include "intake/served.hpp"
#include "site/site.hpp"

namespace adit::api {
namespace {

std::string file_on_disk(std::string_view path) {
  std::ifstream file(std::string(ADIT_SOURCE_DIR "/firmware/site/files") + std::string(path),
                     std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// As a script has them: "Survivor", "Cell Phone" and so on.
std::string artifact_types() {
  std::string words;
  for (const std::string_view type : icd::kArtifactTypes)
    words.append(words.empty() ? "\"" : ", \"").append(type).append("\"");
  return words;
}

/// Scripts are embedded without the lines that are a comment and with the artifact types, style without its
/// comments, pages without what indents their lines.
std::string as_embedded(std::string_view path) {
  std::string text = file_on_disk(path);
  static const std::regex style_comment(R"( */\*[^*]*\*/)");
  if (path.ends_with(".css")) return std::regex_replace(text, style_comment, "");
  static const std::regex indent(R"(\n +)");
  if (path.ends_with(".html")) return std::regex_replace(text, indent, "\n");
  if (!path.ends_with(".js")) return text;
  static const std::regex comment(R"((^|\n) *(//[^\n]*|/\*\*[^\n]*\*/))");
  static const std::regex types(R"("artifact_types\.inc")");
  return std::regex_replace(std::regex_replace(text, comment, "$1"), types, artifact_types());
}

using testing::HasSubstr;
using testing::StartsWith;

class PageTest : public OnPage {};

TEST_F(PageTest, ServesItsFilesWithTheirTypes) {
  EXPECT_EQ(get_file("/").content_type, "text/html; charset=utf-8");
  EXPECT_THAT(get_file("/").body, StartsWith("<!doctype html>"));
  EXPECT_EQ(get_file("/page.css").content_type, "text/css; charset=utf-8");
  EXPECT_EQ(get_file("/page.js").content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(get_file("/icon.svg").content_type, "image/svg+xml");
}

TEST_F(PageTest, EmbedsItsFilesByteForByte) {
  for (const site::File& file : site::embedded_files()) {
    EXPECT_EQ(get_file(std::string(file.path)).body, as_embedded(file.path)) << file.path;
    EXPECT_NE(content_type_of(file), "application/octet-stream") << file.path;
  }
}

TEST_F(PageTest, SendsAFileAgainOnlyWhereItChanged) {
  const auto first = get_file("/page.css");
  EXPECT_EQ(header(first, "Cache-Control"), "no-cache");
  const auto again = get_file("/page.css", header(first, "ETag"));
  EXPECT_EQ(static_cast<int>(again.status), 304);
  EXPECT_EQ(again.body, "");
  EXPECT_EQ(header(again, "ETag"), header(first, "ETag"));
  EXPECT_EQ(get_file("/page.css", "W/\"old\", " + header(first, "ETag")).body, "");
  EXPECT_EQ(get_file("/page.css", "\"old\"").body, first.body);
}

TEST_F(PageTest, EveryAnswerKeepsTheBrowserFromLoadingAnythingElse) {
  for (const char* path : {"/", "/page.js", "/adit/run", "/nothing"}) {
    const auto answer = get_file(path);
    EXPECT_THAT(header(answer, "Content-Security-Policy"), StartsWith("default-src 'none'")) << path;
    EXPECT_EQ(header(answer, "Content-Security-Policy").find("unsafe"), std::string::npos);
    EXPECT_EQ(header(answer, "X-Content-Type-Options"), "nosniff") << path;
    EXPECT_EQ(header(answer, "Referrer-Policy"), "no-referrer") << path;
  }
}

TEST_F(PageTest, HasNoScriptAndNoStyleThatItsPolicyWouldForbid) {
  const std::string html = get_file("/").body;
  EXPECT_EQ(html.find("<style"), std::string::npos);
  EXPECT_EQ(html.find(" style="), std::string::npos);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos) << "every byte is served by the box itself";
}

TEST_F(PageTest, AnswersAnythingElseWithAJsonString) {
  for (const char* path :
       {"/nothing", "/page", "/../page.css", "/files/page.css", "/adit/", "/adit/run/", ""}) {
    const auto answer = get_file(path);
    EXPECT_EQ(answer.status, icd::Status::NotFound) << path;
    EXPECT_EQ(answer.content_type, "application/json");
    EXPECT_TRUE(nlohmann::json::parse(answer.body).is_string());
  }
}

TEST_F(PageTest, TakesNothingButGet) {
  for (const char* path : {"/", "/page.css"}) {
    for (const char* method : {"POST", "DELETE", "OPTIONS"}) {
      const auto answer = get_file(path, "", method);
      EXPECT_EQ(answer.status, icd::Status::MethodNotAllowed) << method << ' ' << path;
      EXPECT_EQ(header(answer, "Allow"), "GET, HEAD");
    }
  }
}

TEST_F(PageTest, GivesTheRunAsJsonThatNobodyKeeps) {
  source.now = *scene("calm", 1000, 0);
  const auto answer = get_file("/adit/run");
  EXPECT_EQ(answer.content_type, "application/json");
  EXPECT_EQ(header(answer, "Cache-Control"), "no-store");
  EXPECT_EQ(answer.body, codec::to_json(source.now));
}

TEST(PageOnAServer, ServesABrowser) {
  std::unique_ptr<Api> api;
  Forward forward;
  FakeOperator judge;
  FakeKeys keys;
  intake::Served served{forward};
  FakeSource source;
  source.now = *scene("calm", 1000, 0);
  served.on_loop([&] {
    api = std::make_unique<Api>(served.loop(), Served{source, judge, keys}, std::vector{token()});
    forward.to = api.get();
  });

  intake::RawClient client{served.port()};
  client.send(intake::request("GET", "/page.css"));
  const auto style = client.reply();
  ASSERT_TRUE(style);
  EXPECT_EQ(style->status, 200);
  EXPECT_EQ(style->body, as_embedded("/page.css"));
  client.send(intake::request("GET", "/page.css", "If-None-Match: " + style->header("etag") + "\r\n"));
  const auto again = client.reply();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_EQ(again->body, "");

  client.send(intake::request("GET", "/adit/events", "Authorization: Bearer team-1\r\n"));
  EXPECT_TRUE(client.wait_for("text/event-stream"));
  EXPECT_TRUE(client.wait_for("\"score\":7"));
  served.on_loop([&] {
    source.now.run->score = 8;
    api->changed();
  });
  EXPECT_TRUE(client.wait_for("\"score\":8"));
  served.on_loop([&] { forward.to = nullptr, api.reset(); });
  EXPECT_TRUE(client.wait_for("\r\n0\r\n\r\n")) << "the stream ends with the page";
}

}  // namespace
}  // namespace adit::api
