#include "access/admission.hpp"

#include <gtest/gtest.h>

namespace adit::access {
namespace {

using namespace std::chrono_literals;
using Status = icd::Status;

constexpr Instant kNow{1000h};

class VerdictTest : public testing::Test {
 protected:
  VerdictTest() {
    const Session viewer = sessions.begin({1}, {2}, Role::Viewer, {"10.0.0.5", ""}, kNow);
    const Session supervisor = sessions.begin({3}, {4}, Role::Operator, {"10.0.0.6", ""}, kNow);
    viewers_cookie = "theme=dark; adit-8000=" + viewer.id.reveal();
    viewers_csrf = viewer.csrf.reveal();
    operators_cookie = "adit-8000=" + supervisor.id.reveal();
    operators_csrf = supervisor.csrf.reveal();
  }
  Request get() const {
    return {.method = "GET",
            .host = "10.0.0.1:8000",
            .origin = {},
            .cookie = {},
            .authorization = {},
            .csrf = {}};
  }
  Request post() const {
    Request request = get();
    request.method = "POST";
    return request;
  }
  /// 200 if the request is admitted.
  Status verdict(const Request& request, Role role, Instant now = kNow) {
    const auto visitor = admit(request, role, tokens, sessions, now);
    return visitor ? Status::Ok : visitor.error().status;
  }

  Sessions sessions;
  std::vector<icd::BearerToken> tokens{*icd::BearerToken::parse("team-1"),
                                       *icd::BearerToken::parse("scoring-1")};
  std::string viewers_cookie, viewers_csrf, operators_cookie, operators_csrf;
};

TEST_F(VerdictTest, RejectsUnauthenticatedClients) {
  EXPECT_EQ(verdict(get(), Role::Viewer), Status::Unauthorized);
  EXPECT_EQ(verdict(post(), Role::Operator), Status::Unauthorized);
  Request request = get();
  for (const char* cookie : {"adit-8000=", "adit-8000=0", "adit-8000", "other=1"}) {
    request.cookie = cookie;
    EXPECT_EQ(verdict(request, Role::Viewer), Status::Unauthorized) << cookie;
  }
}

TEST_F(VerdictTest, ViewersReadAndOperatorsAct) {
  struct Case {
    const char* method;
    bool by_operator;
    Role needed;
    Status status;
  };
  for (const auto& [method, by_operator, needed, status] :
       {Case{"GET", false, Role::Viewer, Status::Ok}, Case{"HEAD", false, Role::Viewer, Status::Ok},
        Case{"GET", false, Role::Operator, Status::Forbidden},
        Case{"POST", false, Role::Operator, Status::Forbidden}, Case{"POST", false, Role::Viewer, Status::Ok},
        Case{"GET", true, Role::Viewer, Status::Ok}, Case{"GET", true, Role::Operator, Status::Ok},
        Case{"POST", true, Role::Operator, Status::Ok}, Case{"PUT", true, Role::Operator, Status::Ok}}) {
    Request request = get();
    request.method = method;
    request.cookie = by_operator ? operators_cookie : viewers_cookie;
    request.csrf = by_operator ? operators_csrf : viewers_csrf;
    EXPECT_EQ(verdict(request, needed), status) << method << ' ' << name_of(needed);
  }
}

TEST_F(VerdictTest, RequiresTheSessionsCsrfTokenForChanges) {
  Request request = post();
  request.cookie = operators_cookie;
  for (const std::string& csrf : {std::string(), std::string("0"), viewers_csrf, operators_csrf + "0"}) {
    request.csrf = csrf;
    for (const char* method : {"POST", "PUT", "DELETE", "PATCH", "OPTIONS", "get"}) {
      request.method = method;
      EXPECT_EQ(verdict(request, Role::Operator), Status::Forbidden) << method << csrf;
    }
  }
  request.csrf = {};
  request.method = "HEAD";
  EXPECT_EQ(verdict(request, Role::Operator), Status::Ok);
}

TEST_F(VerdictTest, AcceptsEachTokenAsOperatorWithoutCsrf) {
  Request request = post();
  for (const char* good : {"Bearer team-1", "bearer scoring-1"}) {
    request.authorization = good;
    EXPECT_EQ(verdict(request, Role::Operator), Status::Ok) << good;
  }
  for (const char* bad : {"Bearer", "Bearer team-", "Basic team-1", "team-1", "Bearer team-1x"}) {
    request.authorization = bad;
    request.cookie = operators_cookie;  // a request with a token is judged only by the token
    request.csrf = operators_csrf;
    EXPECT_EQ(verdict(request, Role::Operator), Status::Unauthorized) << bad;
  }
  tokens.clear();
  request.authorization = "Bearer ";
  EXPECT_EQ(verdict(request, Role::Viewer), Status::Unauthorized) << "a missing token must not give access";
}

TEST_F(VerdictTest, RejectsPagesOfOtherOrigins) {
  Request request = post();
  request.cookie = operators_cookie;
  request.csrf = operators_csrf;
  for (const char* origin :
       {"http://evil.example", "null", "http://10.0.0.1", "http://10.0.0.1:8000.evil.example"}) {
    request.origin = origin;
    EXPECT_EQ(verdict(request, Role::Viewer), Status::Forbidden) << origin;
  }
  request.origin = "http://10.0.0.1:8000";
  EXPECT_EQ(verdict(request, Role::Viewer), Status::Ok);
  request.host = "evil.example:8000";
  request.origin = "http://evil.example:8000";
  EXPECT_EQ(verdict(request, Role::Viewer), Status::Forbidden) << "DNS rebinding";
  request.cookie = {};
  request.authorization = "Bearer team-1";
  EXPECT_EQ(verdict(request, Role::Viewer), Status::Forbidden);
}

TEST_F(VerdictTest, RejectsAnEndedSession) {
  Request request = get();
  request.cookie = operators_cookie;
  const auto visitor = admit(request, Role::Viewer, tokens, sessions, kNow);
  ASSERT_TRUE(visitor && visitor->session);
  sessions.end(visitor->session->number);
  EXPECT_EQ(verdict(request, Role::Viewer), Status::Unauthorized);
  request.cookie = viewers_cookie;
  EXPECT_EQ(verdict(request, Role::Viewer, kNow + 12h), Status::Unauthorized);
}

}  // namespace
}  // namespace adit::access
