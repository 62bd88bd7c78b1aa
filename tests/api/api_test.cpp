#include "api/api.hpp"

#include <gmock/gmock.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <span>

#include "api/answers.hpp"
#include "api/on_page.hpp"
#include "api/scenes.hpp"
#include "codec/gzip.hpp"
#include "icd/scoring.hpp"
#include "intake/raw_client.hpp"
#include "intake/served.hpp"
#include "site/site.hpp"

namespace adit::api {
namespace {

/// The path of the first file that an HTML page names with `attribute`: `rel="stylesheet"` or
/// `type="module"`.
std::string named_in(const std::string& html, const std::string& attribute) {
  std::smatch found;
  const std::regex tag("<[^>]*" + attribute + "[^>]*>"), file(R"re((?:href|src)="([^"]+)")re");
  if (!std::regex_search(html, found, tag)) return "";
  const std::string text = found.str();
  return std::regex_search(text, found, file) ? "/" + found[1].str() : "";
}

std::string gunzipped(const std::string& bytes) {
  const std::span all(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  std::string text;
  const auto size =
      codec::gunzip(icd::ChunkedBytes(all), 1u << 20, "", [&text](std::span<const std::uint8_t> piece) {
        text.append(piece.begin(), piece.end());
        return icd::Checked<void>{};
      });
  EXPECT_TRUE(size);
  return text;
}

using testing::HasSubstr;
using testing::StartsWith;

class PageTest : public OnPage {
 protected:
  std::string style() { return named_in(get_file("/").body, R"(rel="stylesheet")"); }
  std::string script() { return named_in(get_file("/").body, R"(type="module")"); }
  intake::Answer get_packed(const std::string& path, std::string if_none_match = "") {
    return request("GET", path,
                   {{"Accept-Encoding", "gzip, br"}, {"If-None-Match", std::move(if_none_match)}, kByToken});
  }
};

TEST_F(PageTest, ServesItsFilesWithTheirTypes) {
  EXPECT_EQ(get_file("/").content_type, "text/html; charset=utf-8");
  EXPECT_THAT(get_file("/").body, StartsWith("<!doctype html>"));
  EXPECT_EQ(get_file(style()).content_type, "text/css; charset=utf-8");
  EXPECT_EQ(get_file(script()).content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(get_file("/icon.svg").content_type, "image/svg+xml");
}

TEST_F(PageTest, EachPageHasOneStyleAndOneScript) {
  static const std::regex style_link("rel=\"stylesheet\""), module("type=\"module\"");
  for (const char* path : {"/", "/display", "/setup", "/system", "/login.html"}) {
    const std::string html = get_file(path).body;
    for (const auto& [form, attribute] :
         {std::pair{&style_link, R"(rel="stylesheet")"}, {&module, R"(type="module")"}}) {
      EXPECT_EQ(std::distance(std::sregex_iterator(html.begin(), html.end(), *form), {}), 1) << path;
      EXPECT_EQ(get_file(named_in(html, attribute)).status, icd::Status::Ok) << path << ' ' << attribute;
    }
  }
}

TEST_F(PageTest, GivesAScriptTheArtifactTypes) {
  const std::string text = get_file(script()).body;
  for (const std::string_view type : icd::kArtifactTypes)
    EXPECT_THAT(text, HasSubstr('"' + std::string(type) + '"'));
  EXPECT_EQ(text.find("artifact_types.inc"), std::string::npos);
}

TEST_F(PageTest, ServesEmbeddedFilesPackedOrInflated) {
  ASSERT_GT(site::embedded_files().size(), 10U);
  for (const site::File& file : site::embedded_files()) {
    const std::string path(file.path);
    const auto plain = get_file(path), packed = get_packed(path);
    EXPECT_EQ(header(plain, "Content-Encoding"), "") << path;
    EXPECT_EQ(header(packed, "Content-Encoding"), "gzip") << path;
    EXPECT_EQ(packed.body, file.packed) << path;
    EXPECT_EQ(gunzipped(packed.body), plain.body) << path;
    EXPECT_NE(header(plain, "ETag"), header(packed, "ETag")) << path;
    for (const auto* answer : {&plain, &packed}) EXPECT_EQ(header(*answer, "Vary"), "Accept-Encoding");
    EXPECT_NE(content_type_of(file), "application/octet-stream") << path;
  }
}

TEST_F(PageTest, SendsAFileAgainOnlyIfItChanged) {
  const auto first = get_file("/"), packed = get_packed("/");
  EXPECT_EQ(header(first, "Cache-Control"), "no-cache");
  const auto again = get_file("/", header(first, "ETag"));
  EXPECT_EQ(static_cast<int>(again.status), 304);
  EXPECT_EQ(again.body, "");
  EXPECT_EQ(header(again, "ETag"), header(first, "ETag"));
  EXPECT_EQ(get_packed("/", header(packed, "ETag")).body, "");
  EXPECT_EQ(get_packed("/", header(first, "ETag")).body, packed.body) << "the ETag belongs to other bytes";
  EXPECT_EQ(get_file("/", "W/\"old\", " + header(first, "ETag")).body, "");
  EXPECT_EQ(get_file("/", "\"old\"").body, first.body);
}

TEST_F(PageTest, MarksOnlyFilesNamedByContentImmutable) {
  for (const std::string& path : {style(), script()}) {
    EXPECT_THAT(path, testing::ContainsRegex("^/index[.][0-9a-f]{12}[.](css|js)$"));
    EXPECT_EQ(header(get_file(path), "Cache-Control"), "public, max-age=31536000, immutable");
  }
  for (const char* path : {"/", "/setup", "/help", "/icon.svg", "/login.html"})
    EXPECT_EQ(header(get_file(path), "Cache-Control"), "no-cache") << path;
}

TEST_F(PageTest, PacksLongAnswersForClientsThatAcceptGzip) {
  source.now = *scene("reports", 1000, 0);
  const auto plain = get_file("/adit/run"), packed = get_packed("/adit/run");
  EXPECT_EQ(header(plain, "Content-Encoding"), "");
  EXPECT_EQ(header(packed, "Content-Encoding"), "gzip");
  EXPECT_EQ(header(packed, "Cache-Control"), "no-store");
  EXPECT_EQ(gunzipped(packed.body), plain.body);
  EXPECT_EQ(header(get_packed("/adit/session"), "Content-Encoding"), "") << "a short body is not compressed";
}

TEST(AcceptsGzip, FollowsTheCodingAndItsWeight) {
  for (const char* yes : {"gzip", "GZIP", "deflate, gzip", "br;q=1.0, gzip;q=0.8", "*", "x-gzip",
                          "gzip ; q=0.001", "*;q=0, gzip"})
    EXPECT_TRUE(accepts_gzip(yes)) << yes;
  for (const char* no :
       {"", "identity", "br", "gzip;q=0", "gzip; Q=0.000", "*;q=0", "gzipped", "*, gzip;q=0", ",,;"})
    EXPECT_FALSE(accepts_gzip(no)) << no;
}

TEST_F(PageTest, EveryAnswerForbidsForeignContent) {
  for (const std::string& path :
       {std::string("/"), script(), std::string("/adit/run"), std::string("/nothing")}) {
    const auto answer = get_file(path);
    EXPECT_THAT(header(answer, "Content-Security-Policy"), StartsWith("default-src 'none'")) << path;
    EXPECT_EQ(header(answer, "Content-Security-Policy").find("unsafe"), std::string::npos);
    EXPECT_EQ(header(answer, "X-Content-Type-Options"), "nosniff") << path;
    EXPECT_EQ(header(answer, "Referrer-Policy"), "no-referrer") << path;
  }
}

TEST_F(PageTest, HasNoInlineScriptOrStyle) {
  const std::string html = get_file("/").body;
  EXPECT_EQ(html.find("<style"), std::string::npos);
  EXPECT_EQ(html.find(" style="), std::string::npos);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos) << "the page loads only from the box";
}

TEST_F(PageTest, AnswersUnknownPathsWithAJsonString) {
  for (const char* path :
       {"/nothing", "/page", "/../login.html", "/files/login.html", "/page.js", "/adit/", "/adit/run/", ""}) {
    const auto answer = get_file(path);
    EXPECT_EQ(answer.status, icd::Status::NotFound) << path;
    EXPECT_EQ(answer.content_type, "application/json");
    EXPECT_EQ(nlohmann::json::parse(answer.body), "there is no resource at \"" + std::string(path) + "\"");
  }
}

TEST_F(PageTest, SuggestsTheUriThatWasMeant) {
  for (const auto& [path, meant] :
       {std::pair("/map/updates", "/map/update"), std::pair("//map/update", "/map/update"),
        std::pair("/marker/update", "/markers/update"),
        std::pair("/api/artifact_report", "/api/artifact_reports")}) {
    EXPECT_EQ(nlohmann::json::parse(get_file(path, "", "POST").body),
              "there is no resource at \"" + std::string(path) + "\"; did you mean " + meant + "?");
  }
}

TEST_F(PageTest, AcceptsOnlyGet) {
  for (const char* path : {"/", "/icon.svg"}) {
    for (const char* method : {"POST", "DELETE", "OPTIONS"}) {
      const auto answer = get_file(path, "", method);
      EXPECT_EQ(answer.status, icd::Status::MethodNotAllowed) << method << ' ' << path;
      EXPECT_EQ(header(answer, "Allow"), "GET, HEAD");
    }
  }
}

TEST_F(PageTest, GivesTheRunAsUncachedJson) {
  source.now = *scene("calm", 1000, 0);
  const auto answer = get_file("/adit/run");
  EXPECT_EQ(answer.content_type, "application/json");
  EXPECT_EQ(header(answer, "Cache-Control"), "no-store");
  EXPECT_EQ(answer.body, codec::to_json(source.now));
}

/// Includes tokens that are set while the page is open.
TEST_F(PageTest, RedactsTokensInPatches) {
  source.now = *scene("calm", 1000, 0);
  open("GET", "/adit/events", {kByToken}, std::nullopt);
  ASSERT_TRUE(responder->streaming);
  const auto page = responder->streaming;
  for (const std::string typed : {"scoring-1", "rust871}backdoor"}) {
    api.set_tokens({token()}, icd::Redaction({token(typed)}));
    source.now.robots.insert(source.now.robots.begin(), facts::RobotRow{})->name = typed;
    source.now.verdict.why = "not " + typed;
    source.now.alarms.emplace_back().id = "robot_silent:" + typed;
    const std::size_t before = page->sent.size();
    api.on_changed();
    for (int i = 0; i < 1000 && page->sent.size() == before; ++i) loop.turn(std::chrono::milliseconds{10});
    ASSERT_GT(page->sent.size(), before);
    const std::string& event = page->sent.back();
    EXPECT_THAT(event, StartsWith("event: patch\n"));
    EXPECT_THAT(event, HasSubstr("not [token]"));
    EXPECT_THAT(event, HasSubstr(R"("name":"[token]")"));
    EXPECT_EQ(event.find(typed), std::string::npos) << event;
  }
}

TEST(PageOnAServer, ServesABrowser) {
  std::unique_ptr<Api> api;
  Forward forward;
  intake::Served served{forward};
  Doubles doubles;
  doubles.source.now = *scene("calm", 1000, 0);
  served.on_loop([&] {
    api = std::make_unique<Api>(served.loop(), doubles.served(), std::vector{token()});
    forward.to = api.get();
  });

  intake::RawClient client{served.port()};
  client.send(intake::request("GET", "/icon.svg"));
  const auto icon = client.reply();
  ASSERT_TRUE(icon);
  EXPECT_EQ(icon->status, 200);
  EXPECT_THAT(icon->body, StartsWith("<svg"));
  client.send(intake::request("GET", "/icon.svg", "If-None-Match: " + icon->header("etag") + "\r\n"));
  const auto again = client.reply();
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status, 304);
  EXPECT_EQ(again->body, "");

  client.send(intake::request("GET", "/adit/events", "Authorization: Bearer team-1\r\n"));
  EXPECT_TRUE(client.wait_for("text/event-stream"));
  EXPECT_TRUE(client.wait_for("\"score\":7"));
  served.on_loop([&] {
    doubles.source.now.run->score = 8;
    api->on_changed();
  });
  EXPECT_TRUE(client.wait_for("\"score\":8"));
  served.on_loop([&] { forward.to = nullptr, api.reset(); });
  EXPECT_TRUE(client.wait_for("\r\n0\r\n\r\n")) << "the stream did not end";
}

}  // namespace
}  // namespace adit::api
