#include "api/session_routes.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "api/on_page.hpp"

namespace adit::api {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
using Status = icd::Status;
using Headers = std::vector<intake::Header>;

struct Browser {
  std::string cookie, csrf;
};

class SessionRoutesTest : public OnPage {
 protected:
  std::shared_ptr<FakeResponder> begin(const std::string& method, const std::string& path, Headers headers,
                                       const std::string& body = "") {
    const auto sink = open(method, path, std::move(headers), body.size());
    send(sink.get(), body);
    return responder;
  }
  intake::Answer ask(const std::string& method, const std::string& path, Headers headers,
                     const std::string& body = "") {
    return request(method, path, std::move(headers), body);
  }
  static Headers of(const Browser& browser) {
    return {{"Cookie", "adit-8000=" + browser.cookie},
            {"Adit-CSRF", browser.csrf},
            {"Origin", "http://10.0.0.1:8000"},
            {"Content-Type", "application/json"}};
  }
  intake::Answer get(const std::string& path, const Browser& browser = {}) {
    return ask("GET", path, {{"Cookie", "adit-8000=" + browser.cookie}});
  }
  intake::Answer post(const std::string& path, const json& body, const Browser& browser = {}) {
    return ask("POST", path, of(browser), body.dump());
  }
  Browser log_in(const std::string& password) {
    const auto answer = post("/adit/login", {{"password", password}});
    EXPECT_EQ(answer.status, Status::Ok);
    const std::string cookie = header(answer, "Set-Cookie");
    const std::size_t begin = cookie.find('=') + 1;
    return {cookie.substr(begin, cookie.find(';') - begin), json::parse(answer.body)["csrf"]};
  }
  json session(const Browser& browser = {}) { return json::parse(get("/adit/session", browser).body); }
};

TEST_F(SessionRoutesTest, TellAnyClientItsRole) {
  json expected{{"role", nullptr},      {"csrf", nullptr}, {"first_start", false},
                {"set_up_open", false}, {"secure", false}, {"https", true}};
  EXPECT_EQ(session(), expected);
  const Browser mine = log_in("correct horse");
  expected["role"] = "operator";
  expected["csrf"] = mine.csrf;
  EXPECT_EQ(session(mine), expected);
  EXPECT_EQ(session(log_in("look, do not touch"))["role"], "viewer");
  const json script = json::parse(ask("GET", "/adit/session", {kByToken}).body);
  expected["csrf"] = nullptr;
  EXPECT_EQ(script, expected);
}

TEST_F(SessionRoutesTest, SetASecureCookieOverTls) {
  by_tls = true;
  const std::string origin = "https://10.0.0.1";
  const Headers headers = {{"Host", "10.0.0.1"}, {"Origin", origin}, {"Content-Type", "application/json"}};
  const auto answer = ask("POST", "/adit/login", headers, json{{"password", "correct horse"}}.dump());
  const std::string cookie = header(answer, "Set-Cookie");
  EXPECT_THAT(cookie, AllOf(StartsWith("__Host-adit="), HasSubstr("; Path=/"), EndsWith("; Secure")));
  const std::string shown = cookie.substr(0, cookie.find(';'));
  const auto role = [&](const std::string& name) {
    return json::parse(ask("GET", "/adit/session", {{"Host", "10.0.0.1"}, {"Cookie", name}}).body)["role"];
  };
  EXPECT_EQ(role(shown), "operator");
  EXPECT_EQ(role(shown.substr(sizeof "__Host-" - 1)), nullptr) << "set by an answer without TLS";
  by_tls = false;
  EXPECT_EQ(role(shown), nullptr);
}

TEST_F(SessionRoutesTest, OverTlsRejectAPageThatCameWithoutIt) {
  by_tls = true;
  const Headers headers = {
      {"Host", "10.0.0.1"}, {"Origin", "http://10.0.0.1"}, {"Content-Type", "application/json"}};
  EXPECT_EQ(ask("POST", "/adit/login", headers, json{{"password", "correct horse"}}.dump()).status,
            Status::Forbidden);
}

TEST_F(SessionRoutesTest, SetAStrictHttpOnlyCookie) {
  const auto answer = post("/adit/login", {{"password", "correct horse"}});
  EXPECT_THAT(
      header(answer, "Set-Cookie"),
      AllOf(StartsWith("adit-8000="), EndsWith("; HttpOnly; SameSite=Strict; Path=/; Max-Age=604800")));
  EXPECT_EQ(header(answer, "Cache-Control"), "no-store");
  EXPECT_EQ(json::parse(answer.body)["role"], "operator");
}

/// Browsers send a host's cookies to each of its ports.
TEST_F(SessionRoutesTest, KeepTheSessionsOfTwoBoxesOnOneHostApart) {
  const auto at = [](const char* port, const std::string& cookies) {
    return Headers{{"Host", std::string("adit.local:") + port},
                   {"Cookie", cookies},
                   {"Content-Type", "application/json"}};
  };
  const std::string body = R"({"password": "correct horse"})";
  const auto first = ask("POST", "/adit/login", at("8000", ""), body);
  const auto second = ask("POST", "/adit/login", at("8001", ""), body);
  const auto cookie_of = [](const intake::Answer& answer) {
    const std::string set = header(answer, "Set-Cookie");
    return set.substr(0, set.find(';'));
  };
  EXPECT_THAT(cookie_of(first), StartsWith("adit-8000="));
  EXPECT_THAT(cookie_of(second), StartsWith("adit-8001="));
  const std::string both = cookie_of(second) + "; " + cookie_of(first);
  EXPECT_EQ(ask("GET", "/adit/run", at("8000", both)).status, Status::Ok);
  EXPECT_EQ(ask("GET", "/adit/run", at("8001", both)).status, Status::Ok);
  EXPECT_EQ(ask("GET", "/adit/run", at("8000", cookie_of(second))).status, Status::Ok)
      << "a box that moved from port 8001 to 8000 keeps its sessions";
  EXPECT_EQ(ask("GET", "/adit/run", at("8000", "adit-8001=of-the-other-box")).status, Status::Unauthorized);
}

TEST_F(SessionRoutesTest, EndASessionAtLogout) {
  const Browser mine = log_in("correct horse"), other = log_in("correct horse");
  const auto answer = post("/adit/logout", json::object(), mine);
  EXPECT_EQ(answer.status, Status::Ok);
  EXPECT_EQ(header(answer, "Set-Cookie"), "adit-8000=; HttpOnly; SameSite=Strict; Path=/; Max-Age=0");
  EXPECT_EQ(get("/adit/run", mine).status, Status::Unauthorized);
  EXPECT_EQ(get("/adit/run", other).status, Status::Ok);
}

TEST_F(SessionRoutesTest, ReplaceTheSessionAtANewLogin) {
  const Browser mine = log_in("look, do not touch");
  EXPECT_EQ(post("/adit/login", {{"password", "correct horse"}}, mine).status, Status::Ok);
  EXPECT_EQ(get("/adit/run", mine).status, Status::Unauthorized);
}

TEST_F(SessionRoutesTest, RejectGuessesUncheckedAfterFive) {
  for (int i = 0; i < 5; ++i) {
    const auto answer = post("/adit/login", {{"password", "guess"}});
    EXPECT_EQ(answer.status, Status::Forbidden);
    EXPECT_EQ(header(answer, "Set-Cookie"), "");
  }
  const auto answer = post("/adit/login", {{"password", "correct horse"}});
  EXPECT_EQ(answer.status, Status::TooManyRequests);
  EXPECT_EQ(header(answer, "Retry-After"), "1");
  EXPECT_EQ(keys.checked, 5);
}

/// After wrong passwords, each further log-in is delayed, for minutes.
class GuessedAtTest : public SessionRoutesTest {
 protected:
  void guess_from_everywhere() {
    for (int i = 0; i < 200; ++i) {
      peer = "10.0.1." + std::to_string(i);
      post("/adit/login", {{"password", "guess"}});
    }
    peer = "10.0.0.7";
  }
  intake::Answer try_to(const std::string& device) {
    return ask("POST", "/adit/login", {{"Cookie", device}, {"Content-Type", "application/json"}},
               R"({"password":"correct horse"})");
  }
  std::string device_after_login() {
    const auto answer = try_to("");
    for (const auto& [name, value] : answer.headers) {
      if (name == "Set-Cookie" && value.starts_with("adit-device-8000="))
        return value.substr(0, value.find(';'));
    }
    return "";
  }
};

TEST_F(GuessedAtTest, TellUnknownClientsWhenToRetry) {
  guess_from_everywhere();
  const auto answer = try_to("");
  EXPECT_EQ(answer.status, Status::TooManyRequests);
  EXPECT_EQ(json::parse(answer.body).get<std::string>(),
            "other clients are trying passwords: wait " + header(answer, "Retry-After") +
                " s, or press the box's button and try again at once");
}

TEST_F(GuessedAtTest, AdmitAKnownDevice) {
  const std::string device = device_after_login();
  ASSERT_THAT(device, StartsWith("adit-device-8000="));
  guess_from_everywhere();
  const auto answer = try_to(device);
  EXPECT_EQ(answer.status, Status::Ok);
  EXPECT_EQ(std::ranges::count(answer.headers, "Set-Cookie", &intake::Header::name), 1)
      << "the session must stay the same";
}

TEST_F(GuessedAtTest, ReserveRoomForAKnownDevice) {
  const std::string device = device_after_login();
  EXPECT_EQ(api.read_credentials(FakeHead("POST", "/adit/login", {{"Cookie", device}})),
            intake::Credentials::Enough);
  EXPECT_EQ(api.read_credentials(FakeHead("POST", "/adit/login", {{"Cookie", "adit-device-8000=guessed"}})),
            intake::Credentials::Nothing);
}

TEST_F(GuessedAtTest, AdmitTheClientThatPressedTheButton) {
  guess_from_everywhere();
  keys.at_box = true;
  EXPECT_EQ(try_to("").status, Status::Ok);
}

TEST_F(GuessedAtTest, ForgetDevicesOfAnOldPassword) {
  const std::string device = device_after_login();
  const Browser mine = log_in("correct horse");
  ASSERT_EQ(post("/adit/password",
                 {{"role", "operator"}, {"current", "correct horse"}, {"password", "another horse"}}, mine)
                .status,
            Status::Ok);
  guess_from_everywhere();
  EXPECT_EQ(try_to(device).status, Status::TooManyRequests);
}

TEST_F(GuessedAtTest, GiveAnOperatorADeviceAfterAViewers) {
  auto answer = post("/adit/login", {{"password", "look, do not touch"}});
  ASSERT_EQ(std::ranges::count(answer.headers, "Set-Cookie", &intake::Header::name), 2);
  const std::string viewers = keys.devices_.all().back().id.reveal();
  EXPECT_EQ(
      std::ranges::count(try_to("adit-device-8000=" + viewers).headers, "Set-Cookie", &intake::Header::name),
      2);
  EXPECT_EQ(keys.devices_.all().back().role, access::Role::Operator);
}

TEST_F(SessionRoutesTest, RejectLoginWith503WhilePasswordsAreUnreadable) {
  keys.unread_ = "the passwords cannot be read: access.json: Input/output error";
  const intake::Answer answer = post("/adit/login", {{"password", "correct horse"}});
  EXPECT_EQ(answer.status, Status::ServiceUnavailable);
  EXPECT_NE(answer.body.find("access.json"), std::string::npos);
  EXPECT_EQ(keys.checked, 0);
}

TEST_F(SessionRoutesTest, CheckFewPasswordsAtOnce) {
  keys.slow = true;
  const Headers headers = of({});
  std::vector<std::shared_ptr<FakeResponder>> all;
  for (int i = 0; i < 4; ++i) {
    all.push_back(begin("POST", "/adit/login", headers, R"({"password":"correct horse"})"));
    EXPECT_FALSE(all.back()->answered) << "answered before the hash";
  }
  EXPECT_EQ(post("/adit/login", {{"password", "correct horse"}}).status, Status::TooManyRequests);
  keys.answer_all();
  for (const auto& each : all) EXPECT_EQ(each->answered->status, Status::Ok);
}

TEST_F(SessionRoutesTest, SetTheFirstPasswordWithOnlyTheCode) {
  keys.operator_.reset();
  EXPECT_EQ(session()["first_start"], true);
  EXPECT_EQ(post("/adit/login", {{"password", "anything"}}).status, Status::Conflict);
  const json good = {{"role", "operator"}, {"code", "12345678"}, {"password", "a new password"}};
  json body = good;
  body["code"] = "11111111";
  EXPECT_EQ(post("/adit/password", body).status, Status::Forbidden);
  body.erase("code");
  EXPECT_EQ(post("/adit/password", body).status, Status::Forbidden);
  body = good;
  body["password"] = "too short";
  EXPECT_THAT(post("/adit/password", body).body, HasSubstr("password: expected 10 to 128 characters, got 9"));
  body = good;
  body["role"] = "viewer";
  EXPECT_EQ(post("/adit/password", body).status, Status::Conflict);
  EXPECT_EQ(keys.operator_, std::nullopt);

  EXPECT_EQ(post("/adit/password", good).status, Status::Ok);
  EXPECT_EQ(keys.operator_, "a new password");
  EXPECT_EQ(post("/adit/password", good).status, Status::Unauthorized) << "the code is valid once";
  EXPECT_EQ(session(log_in("a new password"))["role"], "operator");
}

TEST_F(SessionRoutesTest, SetAPasswordWithoutCredentialsDuringSetUp) {
  const Browser old = log_in("correct horse"), viewer = log_in("look, do not touch");
  const json body = {{"role", "operator"}, {"password", "a new password"}};
  EXPECT_EQ(post("/adit/password", body).status, Status::Unauthorized) << "the code is not valid yet";
  EXPECT_EQ(session()["set_up_open"], false);
  keys.set_up = true;
  EXPECT_EQ(session()["set_up_open"], true);
  EXPECT_EQ(get("/adit/run", old).status, Status::Ok) << "a session ended too early";
  json wrong = body;
  wrong["password"] = "too short";
  EXPECT_EQ(post("/adit/password", wrong).status, Status::UnprocessableEntity);
  wrong = {{"role", "viewer"}, {"password", "a new password"}};
  EXPECT_EQ(post("/adit/password", wrong).status, Status::Unauthorized)
      << "only an operator may change the viewers' password";
  wrong = {{"role", "operator"}, {"current", "wrong"}, {"password", "a new password"}};
  EXPECT_EQ(post("/adit/password", wrong).status, Status::Unauthorized) << "a stated password is checked";
  EXPECT_EQ(keys.operator_, "correct horse");
  EXPECT_EQ(get("/adit/run", old).status, Status::Ok);

  EXPECT_EQ(post("/adit/password", body).status, Status::Ok);
  EXPECT_EQ(keys.operator_, "a new password");
  EXPECT_EQ(get("/adit/run", old).status, Status::Unauthorized) << "sessions of the old password end";
  EXPECT_EQ(get("/adit/run", viewer).status, Status::Ok);
  EXPECT_EQ(post("/adit/password", body).status, Status::Unauthorized) << "the code is valid once";
}

TEST_F(SessionRoutesTest, OpenNoOtherRouteDuringSetUp) {
  keys.set_up = true;
  for (const char* path : {"/adit/reset", "/adit/logout", "/adit/sessions/1/end", "/adit/runs"}) {
    EXPECT_EQ(post(path, {{"password", "a new password"}}).status, Status::Unauthorized) << path;
  }
  EXPECT_EQ(get("/adit/run").status, Status::Unauthorized);
  Headers headers = of({});
  headers[2].value = "http://evil.example";
  EXPECT_EQ(
      ask("POST", "/adit/password", headers, R"({"role":"operator","password":"a new password"})").status,
      Status::Forbidden)
      << "a page of another origin";
  EXPECT_EQ(ask("POST", "/adit/password", {{"Content-Type", "text/plain"}},
                R"({"role":"operator","password":"a new password"})")
                .status,
            Status::UnprocessableEntity);
  EXPECT_EQ(keys.operator_, "correct horse");
}

TEST_F(SessionRoutesTest, RejectAPasswordIfSetUpClosedMeanwhile) {
  keys.set_up = true;
  const auto late = open("POST", "/adit/password", of({}), std::nullopt);
  ASSERT_NE(late, nullptr);
  keys.set_up = false;
  const std::string body = R"({"role":"operator","password":"a new password"})";
  send(late.get(), body);
  EXPECT_EQ(responder->answered->status, Status::Unauthorized);
  EXPECT_EQ(keys.operator_, "correct horse");
}

TEST_F(SessionRoutesTest, RequireNoCodeDuringSetUpAtTheFirstStart) {
  keys.operator_.reset();
  keys.set_up = true;
  EXPECT_EQ(
      post("/adit/password", {{"role", "operator"}, {"code", "1"}, {"password", "a new password"}}).status,
      Status::Forbidden)
      << "a password that is sent is checked";
  EXPECT_EQ(post("/adit/password", {{"role", "operator"}, {"password", "a new password"}}).status,
            Status::Ok);
  EXPECT_EQ(keys.operator_, "a new password");
}

TEST_F(SessionRoutesTest, LimitGuessesOfTheCode) {
  keys.operator_.reset();
  json body = {{"role", "operator"}, {"code", "11111111"}, {"password", "a new password"}};
  for (int i = 0; i < 5; ++i) EXPECT_EQ(post("/adit/password", body).status, Status::Forbidden);
  body["code"] = "12345678";
  EXPECT_EQ(post("/adit/password", body).status, Status::TooManyRequests);
}

TEST_F(SessionRoutesTest, RejectTheCodeIfAPasswordWasSetMeanwhile) {
  keys.operator_.reset();
  const auto late = open("POST", "/adit/password", of({}), std::nullopt);
  ASSERT_NE(late, nullptr);
  keys.operator_ = "set by somebody else meanwhile";
  const std::string body = R"({"role":"operator","code":"12345678","password":"a new password"})";
  send(late.get(), body);
  EXPECT_EQ(responder->answered->status, Status::Unauthorized);
}

TEST_F(SessionRoutesTest, OperatorChangesBothPasswordsWithTheOwnOne) {
  const Browser mine = log_in("correct horse"), other = log_in("correct horse"),
                viewer = log_in("look, do not touch");
  json change = {{"role", "operator"}, {"current", "wrong"}, {"password", "a new password"}};
  EXPECT_EQ(post("/adit/password", change, mine).status, Status::Forbidden);
  change["current"] = "look, do not touch";
  EXPECT_EQ(post("/adit/password", change, mine).status, Status::Forbidden)
      << "the viewers' password is not enough";
  change["current"] = "correct horse";
  EXPECT_EQ(post("/adit/password", change, mine).status, Status::Ok);
  EXPECT_EQ(keys.operator_, "a new password");
  EXPECT_EQ(get("/adit/run", mine).status, Status::Ok);
  EXPECT_EQ(get("/adit/run", other).status, Status::Unauthorized) << "the role's other sessions end";
  EXPECT_EQ(get("/adit/run", viewer).status, Status::Ok);

  change = {{"role", "viewer"}, {"current", "a new password"}, {"password", nullptr}};
  EXPECT_EQ(post("/adit/password", change, mine).status, Status::Ok);
  EXPECT_EQ(keys.viewer, std::nullopt);
  EXPECT_EQ(get("/adit/run", viewer).status, Status::Unauthorized);
  change["role"] = "operator";
  EXPECT_EQ(post("/adit/password", change, mine).status, Status::UnprocessableEntity);
}

TEST_F(SessionRoutesTest, ListAndEndSessionsForTheOperator) {
  const Browser viewer = log_in("look, do not touch"), mine = log_in("correct horse");
  const json all = json::parse(get("/adit/sessions", mine).body);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["role"], "operator");
  EXPECT_EQ(all[0]["own"], true);
  EXPECT_EQ(all[1]["role"], "viewer");
  EXPECT_EQ(all[1]["own"], false);
  EXPECT_EQ(all[1]["address"], "10.0.0.5");
  EXPECT_NEAR(all[1]["made"], loop.wall_now(), 5);
  EXPECT_EQ(all.dump().find(mine.cookie), std::string::npos);
  const std::string path = "/adit/sessions/" + all[1]["number"].dump() + "/end";
  EXPECT_EQ(post(path, json::object(), mine).status, Status::Ok);
  EXPECT_EQ(get("/adit/run", viewer).status, Status::Unauthorized);
  EXPECT_EQ(post(path, json::object(), mine).status, Status::NotFound);
}

TEST_F(SessionRoutesTest, RejectMalformedRequests) {
  for (const char* body : {"", "{", "[]", "{}", R"({"password":7})", R"({"password":null})"}) {
    const auto answer = ask("POST", "/adit/login", of({}), body);
    EXPECT_TRUE(answer.status == Status::BadRequest || answer.status == Status::UnprocessableEntity) << body;
  }
  EXPECT_EQ(ask("POST", "/adit/login", of({}), std::string(5000, ' ')).status, Status::ContentTooLarge);
  EXPECT_EQ(ask("POST", "/adit/login", {{"Content-Type", "text/plain"}}, "{}").status,
            Status::UnprocessableEntity);
  EXPECT_EQ(keys.checked, 0);
}

}  // namespace
}  // namespace adit::api
