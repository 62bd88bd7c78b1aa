#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "api/on_page.hpp"
#include "api/route.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using Status = icd::Status;
using Headers = std::vector<intake::Header>;

std::string path_of(const Route& route) {
  static const std::regex kind(R"(\{kind\})"), any(R"(\{\w+\})");
  return std::regex_replace(std::regex_replace(std::string(route.path), kind, "grid"), any, "1");
}

std::string name_of(const Route& route) {
  return std::string(route.method) + ' ' + std::string(route.path);
}

struct VisitedPage : Page {
  Headers logged_in(const std::string& password, bool with_csrf = true) {
    const auto answer = request("POST", "/adit/login", {{"Content-Type", "application/json"}},
                                json{{"password", password}}.dump());
    const std::string cookie = header(answer, "Set-Cookie");
    Headers shown{{"Cookie", cookie.substr(0, cookie.find(';'))}, {"Origin", "http://10.0.0.1:8000"}};
    if (with_csrf) shown.push_back({"Adit-CSRF", json::parse(answer.body)["csrf"]});
    return shown;
  }
  /// The status of the answer; 200 for a stream.
  int status_of(const Route& route, Headers headers, const std::string& body = "") {
    headers.push_back({"Content-Type", std::string(route.body.type)});
    send(open(std::string(route.method), path_of(route), std::move(headers), body.size()).get(), body);
    return responder->answered ? static_cast<int>(responder->answered->status) : 200;
  }
};

bool is_for(const Route& route, RouteAccess least) {
  return route.who >= least;
}

/// A kind of visitor, and the status that it gets for a route; 0: it has access.
struct Visitor {
  const char* name;
  Headers (*shows)(VisitedPage&);
  int (*expected)(const Route&);
};
constexpr const char *kOperator = "correct horse", *kViewer = "look, do not touch";
int unauthenticated_status(const Route& route) {
  return is_for(route, RouteAccess::OperatorOrSetUp) ? 401 : 0;
}
int viewer_status(const Route& route) {
  const bool for_operators = route.who == RouteAccess::Operator || route.who == RouteAccess::OperatorOrSetUp;
  return for_operators ? 403 : 0;
}
int status_without_csrf(const Route& route) {
  return is_for(route, RouteAccess::OperatorOrSetUp) && route.method == "POST" ? 403 : 0;
}
int foreign_page_status(const Route& route) {
  return route.who == RouteAccess::Open ? 0 : 403;
}
const Visitor kVisitors[] = {
    {"nobody", [](VisitedPage&) { return Headers{}; }, unauthenticated_status},
    {"another token", [](VisitedPage&) { return Headers{{"Authorization", "Bearer team-1x"}}; },
     unauthenticated_status},
    {"a viewer", [](VisitedPage& page) { return page.logged_in(kViewer); }, viewer_status},
    {"a viewer without CSRF", [](VisitedPage& page) { return page.logged_in(kViewer, false); },
     [](const Route& route) { return std::max(viewer_status(route), status_without_csrf(route)); }},
    {"an operator", [](VisitedPage& page) { return page.logged_in(kOperator); },
     [](const Route&) { return 0; }},
    {"an operator without CSRF", [](VisitedPage& page) { return page.logged_in(kOperator, false); },
     status_without_csrf},
    {"an operator with another session's CSRF",
     [](VisitedPage& page) {
       auto shown = page.logged_in(kOperator, false);
       shown.push_back(page.logged_in(kOperator).back());
       return shown;
     },
     status_without_csrf},
    {"a script", [](VisitedPage&) { return Headers{kByToken}; }, [](const Route&) { return 0; }},
    {"a page from elsewhere",
     [](VisitedPage& page) {
       auto shown = page.logged_in(kOperator);
       shown[1].value = "http://evil.example";
       return shown;
     },
     foreign_page_status},
    {"a page by a name of its own for this address",
     [](VisitedPage& page) {
       auto shown = page.logged_in(kOperator);
       shown[1].value = "http://evil.example:8000";
       shown.push_back({"Host", "evil.example:8000"});
       return shown;
     },
     foreign_page_status},
};

TEST(Routes, EnforceTheTableOfRights) {
  for (const Visitor& visitor : kVisitors) {
    for (const Route& route : routes()) {
      VisitedPage page;
      const int status = page.status_of(route, visitor.shows(page)), expected = visitor.expected(route);
      const bool shut = status == 401 || status == 403;
      EXPECT_EQ(shut ? status : 0, expected) << visitor.name << ", " << name_of(route);
      if (status != 401) continue;
      EXPECT_EQ(header(*page.responder->answered, "WWW-Authenticate"), "Bearer");
    }
  }
}

TEST(Routes, HaveNoEffectWithoutRights) {
  for (const Visitor& visitor : kVisitors) {
    for (const Route& route : routes()) {
      if (visitor.expected(route) == 0) continue;
      VisitedPage page;
      page.status_of(route, visitor.shows(page), R"({"seconds":1,"type":"Drill","x":1,"y":2,"z":3})");
      EXPECT_FALSE(page.took_body && page.responder->answered->status == Status::Ok);
      EXPECT_TRUE(page.decisions.decided.empty() && page.decisions.reported.empty() &&
                  page.decisions.decided_messages.empty());
      EXPECT_EQ(page.decisions.run, 1);
      EXPECT_EQ(page.decisions.identified, 0);
      EXPECT_EQ(page.setup.saves + page.setup.resets + page.network.reverted, 0);
      EXPECT_TRUE(page.network.wanted.empty() && page.network.confirmed.empty());
      EXPECT_FALSE(page.test.view.running);
      EXPECT_TRUE(page.updates.sticks.empty() && page.updates.restarts.empty() &&
                  page.updates.backs.empty() && page.updates.stays == 0);
    }
  }
}

TEST(Routes, OpenOnlyThePasswordDuringSetUp) {
  for (const bool first_start : {false, true}) {
    for (const Route& route : routes()) {
      VisitedPage page;
      page.keys.set_up = !first_start;
      if (first_start) page.keys.operator_.reset();
      const int status = page.status_of(route, {});
      EXPECT_EQ(status == 401, is_for(route, RouteAccess::Viewer)) << name_of(route);
      EXPECT_EQ(page.status_of(route, {{"Origin", "http://evil.example"}}),
                route.who == RouteAccess::Open ? status : 403);
    }
  }
}

TEST(Routes, RejectOtherMethodsWithAnAllowHeader) {
  for (const Route& route : routes()) {
    std::string allowed;
    for (const Route& each : routes()) {
      if (each.path == route.path) allowed += (allowed.empty() ? "" : ", ") + std::string(each.method);
    }
    if (allowed.starts_with("GET")) allowed.insert(3, ", HEAD");
    VisitedPage page;
    for (const char* method : {"DELETE", "PUT", "OPTIONS"}) {
      const auto answer = page.request(method, path_of(route), {kByToken});
      EXPECT_EQ(answer.status, Status::MethodNotAllowed) << method << ' ' << route.path;
      EXPECT_EQ(header(answer, "Allow"), allowed) << route.path;
      const auto first = std::string(allowed.substr(0, allowed.find(',')));
      EXPECT_EQ(json::parse(answer.body), "expected " + first);
      for (const auto& [name, value] : answer.headers) EXPECT_FALSE(name.starts_with("Access-Control"));
    }
    const bool for_anybody = route.who < RouteAccess::OperatorOrSetUp;
    EXPECT_EQ(page.request("DELETE", path_of(route), {}).status,
              for_anybody ? Status::MethodNotAllowed : Status::Unauthorized)
        << route.path;
  }
}

TEST(Routes, CheckTypeAndLengthOfBodies) {
  for (const Route& route : routes()) {
    if (route.method == "GET") continue;
    VisitedPage page;
    const std::string path = path_of(route);
    // Content types that a form or a script of another web page can send without permission (Fetch,
    // CORS-safelisted).
    for (const char* type :
         {"", "text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"}) {
      const auto answer = page.request("POST", path, {kByToken, {"Content-Type", type}}, "{}");
      EXPECT_EQ(answer.status, Status::UnprocessableEntity) << path;
      EXPECT_EQ(json::parse(answer.body), "Content-Type: expected " + std::string(route.body.type));
    }
    const Headers good{kByToken, {"Content-Type", std::string(route.body.type)}};
    EXPECT_FALSE(page.open("POST", path, good, route.body.most + 1)) << path;
    EXPECT_EQ(page.responder->answered->status, Status::ContentTooLarge) << path;
    EXPECT_THAT(page.responder->answered->body,
                HasSubstr(" of at most " + std::to_string(route.body.most) + " bytes"));
    const auto sink = page.open("POST", path, good, route.body.most);
    EXPECT_TRUE(sink) << path << ": the body is not read";
    if (route.body.most > 1u << 20) continue;
    Page::send(page.open("POST", path, good, std::nullopt).get(), std::string(route.body.most + 1, ' '));
    EXPECT_EQ(page.responder->answered->status, Status::ContentTooLarge) << path;
  }
}

TEST(Routes, UnknownPathsRequireALogin) {
  VisitedPage page;
  for (const char* path : {"/adit/", "/adit/nothing", "/adit/reports/7/history"}) {
    EXPECT_EQ(page.request("GET", path, {}).status, Status::Unauthorized) << path;
    EXPECT_EQ(page.get(path).status, Status::NotFound) << path;
    EXPECT_EQ(page.request("POST", path, page.logged_in(kViewer)).status, Status::Forbidden) << path;
  }
}

void collect(const json& value, std::set<std::string>& references) {
  if (value.is_object() && value.contains("$ref")) references.insert(value["$ref"]);
  for (const json& each : value) {
    if (each.is_structured()) collect(each, references);
  }
}

TEST(Description, HasTheRightsAndParametersOfEachRoute) {
  VisitedPage page;
  const json whole = json::parse(page.request("GET", "/adit/openapi.json", {}).body);
  EXPECT_EQ(whole["openapi"], "3.1.0");
  std::size_t operations = 0;
  for (const json& methods : whole["paths"]) operations += methods.size();
  EXPECT_EQ(operations, routes().size());
  for (const Route& route : routes()) {
    const json operation = whole["paths"][std::string(route.path)][route.method == "GET" ? "get" : "post"];
    const std::string role = route.who == RouteAccess::Viewer ? "viewer" : "operator";
    EXPECT_EQ(operation.value("x-adit-role", ""), route.who < RouteAccess::OperatorOrSetUp ? "" : role)
        << route.path;
    EXPECT_EQ(operation.contains("security"), route.who < RouteAccess::OperatorOrSetUp) << route.path;
    EXPECT_EQ(operation.contains("requestBody"), route.method == "POST") << route.path;
    if (operation.contains("requestBody")) {
      EXPECT_TRUE(operation["requestBody"]["content"].contains(std::string(route.body.type))) << route.path;
    }
    std::string named;
    for (const json& each : operation.value("parameters", json::array())) {
      if (each["in"] == "path") named += "{" + each["name"].get<std::string>() + "}";
    }
    static const std::regex between(R"((^|\})[^{}]*(\{|$))");
    EXPECT_EQ(named, std::regex_replace(std::string(route.path), between, "$1$2")) << route.path;
  }
  std::set<std::string> references;
  collect(whole, references);
  EXPECT_GT(references.size(), 20u);
  for (const std::string& each : references) {
    EXPECT_TRUE(whole.contains(json::json_pointer(each.substr(1)))) << each;
  }
}

TEST(Description, IsPublicAndCached) {
  VisitedPage page;
  const auto answer = page.request("GET", "/adit/openapi.json", {});
  EXPECT_EQ(answer.content_type, "application/json");
  const auto again = page.request("GET", "/adit/openapi.json", {{"If-None-Match", header(answer, "ETag")}});
  EXPECT_EQ(static_cast<int>(again.status), 304);
}

}  // namespace
}  // namespace adit::api
