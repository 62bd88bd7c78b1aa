#include "forward/channel.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "../uplink/peer.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

constexpr const char* kRun =
    R"({"score": 1, "run_clock": 2.5, "remaining_reports": 44, "current_team": "subt"})";

class ChannelTest : public testing::Test {
 protected:
  /// A channel after one request with this answer.
  std::unique_ptr<Channel> asked(icd::Uri uri, const std::string& answer, bool is_on_trial = false) {
    peer_.emplace([answer](uplink::Wire& wire) { wire.read_request(), wire.write(answer); });
    auto channel = std::make_unique<Channel>(
        loop_, servers_, "mapping",
        EndpointAccess{peer_->endpoint(), icd::BearerToken::parse("a-token"), std::chrono::seconds{20}},
        [] {});
    bool done = false;
    channel->send(uri, "", {}, [&done](const uplink::Outcome&) { done = true; }, {}, is_on_trial);
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return done; }));
    return channel;
  }

  loop::Loop loop_;
  uplink::Servers servers_{loop_};
  std::optional<uplink::ListeningPeer> peer_;
};

/// A captive portal's page may have any length.
TEST_F(ChannelTest, TakesAPageOfAnyLengthForForeign) {
  for (const char* status : {"200 OK", "302 Found", "403 Forbidden"}) {
    for (const std::size_t size : {100u, 20u << 10, 70u << 10, 1u << 20}) {
      for (const icd::Uri uri : {icd::Uri::Status, icd::Uri::MapUpdate}) {
        SCOPED_TRACE(std::string(status) + ", " + std::to_string(size));
        const auto channel = asked(uri, uplink::answer(status, "<html>" + std::string(size, 'x')));
        EXPECT_TRUE(channel->last().is_foreign());
        EXPECT_EQ(channel->last().foreign(), 1u);
        EXPECT_THAT(channel->trouble(), testing::Not(testing::IsEmpty()));
      }
    }
  }
}

/// ICD 5.1 lists the fields of a status.
TEST_F(ChannelTest, TakesAServerWithoutARunStatusForForeign) {
  for (const char* body : {R"({"hello": "world"})", "null", "[]", "", R"({"score": 1, "run_clock": 2.5})"}) {
    const auto channel = asked(icd::Uri::Status, uplink::answer("200 OK", body));
    EXPECT_TRUE(channel->last().is_foreign()) << body;
    EXPECT_THAT(channel->trouble(), testing::HasSubstr("status of a run")) << body;
    EXPECT_FALSE(asked(icd::Uri::MapUpdate, uplink::answer("200 OK", body))->last().is_foreign()) << body;
  }
  EXPECT_FALSE(asked(icd::Uri::Status, uplink::answer("200 OK", kRun))->last().is_foreign());
}

TEST_F(ChannelTest, IsNoWorseForARejectedMessageOnTrial) {
  const std::string rejection = uplink::answer("403 Forbidden", "\"unknown robot\"");
  EXPECT_EQ(asked(icd::Uri::StateUpdate, rejection)->last().status(), 403);
  const auto channel = asked(icd::Uri::StateUpdate, rejection, true);
  EXPECT_EQ(channel->last().status(), 0);
  EXPECT_EQ(channel->last().ended_requests(), 0u);
  EXPECT_EQ(channel->last().trouble(), "");
  EXPECT_EQ(asked(icd::Uri::StateUpdate, uplink::answer("200 OK", "null"), true)->last().status(), 200);
}

TEST_F(ChannelTest, AcceptsErrorPagesOfTheCommandPost) {
  for (const std::size_t size : {100u, 70u << 10}) {
    const auto channel =
        asked(icd::Uri::MapUpdate, uplink::answer("502 Oops", "<html>" + std::string(size, 'x')));
    EXPECT_FALSE(channel->last().is_foreign());
    EXPECT_NE(channel->trouble(), "");
  }
}

TEST_F(ChannelTest, TakesTheTimeOnlyFromTheCommandPost) {
  struct Case {
    const char *status, *body;
    bool is_its_own;
  };
  for (const Case& each : {Case{"200 OK", kRun, true},
                           {"200 OK", R"({"score": 1})", false},
                           {"201 Created", "null", false},
                           {"200 OK", "", false},
                           {"200 OK", "<html>", false},
                           {"302 Found", "null", false},
                           {"403 Forbidden", R"("log in")", false},
                           {"404 Not Found", "<html>", false},
                           {"429 Too Many Requests", "<html>", false},
                           {"502 Bad Gateway", "<html>", false},
                           {"503 Service Unavailable", R"({"error": "upstream"})", false}}) {
    const auto channel = asked(
        icd::Uri::Status, uplink::answer(each.status, each.body, "Date: Sun, 06 Nov 2033 08:49:37 GMT\r\n"));
    EXPECT_EQ(channel->last().command_post_time().has_value(), each.is_its_own)
        << each.status << ' ' << each.body;
  }
}

TEST_F(ChannelTest, ChangesEndpointAfterTheRequestInFlight) {
  uplink::ListeningPeer there([](uplink::Wire& wire) {
    wire.read_request();
    wire.write(uplink::answer("200 OK", "2"));
  });
  peer_.emplace([](uplink::Wire& wire) {
    wire.read_request();
    wire.write(uplink::answer("429 TOO MANY REQUESTS", R"("slowly")"));
  });
  const auto token = icd::BearerToken::parse("a-token");
  Channel channel(loop_, servers_, "mapping", {peer_->endpoint(), token, std::chrono::seconds{20}}, [] {});
  std::vector<int> answers;
  const auto ask = [&] {
    channel.send(icd::Uri::Status, "", {}, [&](const uplink::Outcome& outcome) {
      const auto* answered = std::get_if<uplink::Answered>(&outcome);
      answers.push_back(answered != nullptr ? answered->status : 0);
    });
  };
  ask();
  channel.lead_to({there.endpoint(), token, std::chrono::seconds{20}});
  EXPECT_FALSE(channel.turns());
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return answers.size() == 1; }));
  EXPECT_EQ(channel.last().status(), 429);
  EXPECT_TRUE(channel.turns());
  EXPECT_FALSE(channel.turns());
  EXPECT_EQ(channel.last().status(), 0) << "of the old endpoint";
  EXPECT_EQ(channel.address(), "127.0.0.1:" + std::to_string(there.endpoint().port));
  ask();
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return answers.size() == 2; }));
  EXPECT_THAT(answers, testing::ElementsAre(429, 200));
}

TEST_F(ChannelTest, GivesUpARequestOnlyForANewEndpoint) {
  peer_.emplace([](uplink::Wire& wire) { wire.read_request(), wire.read_request(); });  // does not answer
  const auto token = icd::BearerToken::parse("a-token"), another = icd::BearerToken::parse("another-token");
  Channel channel(loop_, servers_, "mapping", {peer_->endpoint(), token, std::chrono::seconds{20}}, [] {});
  std::vector<uplink::Outcome> outcomes;
  channel.send(icd::Uri::Status, "", {},
               [&](const uplink::Outcome& outcome) { outcomes.push_back(outcome); });
  channel.give_up();
  channel.lead_to({peer_->endpoint(), token, std::chrono::seconds{10}});
  channel.give_up();
  EXPECT_TRUE(channel.busy());
  EXPECT_THAT(outcomes, testing::IsEmpty());
  channel.lead_to({peer_->endpoint(), another, std::chrono::seconds{10}});
  channel.give_up();
  EXPECT_FALSE(channel.busy());
  ASSERT_EQ(outcomes.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<uplink::InDoubt>(outcomes.front()));
  EXPECT_TRUE(channel.turns());
  EXPECT_EQ(channel.trouble(), "") << "of the old endpoint";
  channel.give_up();
  EXPECT_EQ(outcomes.size(), 1u);
}

TEST_F(ChannelTest, NeedsAToken) {
  peer_.emplace([](uplink::Wire&) {});
  Channel channel(loop_, servers_, "mapping", {peer_->endpoint(), std::nullopt, std::chrono::seconds{20}},
                  [] {});
  EXPECT_FALSE(channel.has_token());
  channel.lead_to({peer_->endpoint(), icd::BearerToken::parse("a-token"), std::chrono::seconds{20}});
  EXPECT_TRUE(channel.turns());
  EXPECT_TRUE(channel.has_token());
}

TEST_F(ChannelTest, KeepsItsStateIfOnlyATimeoutChanges) {
  const auto channel = asked(icd::Uri::Status, uplink::answer("200 OK", "1"));
  uplink::Endpoint slower = peer_->endpoint();
  slower.connect_within = std::chrono::seconds{7};
  channel->lead_to({slower, icd::BearerToken::parse("a-token"), std::chrono::seconds{20}});
  EXPECT_FALSE(channel->turns());
  EXPECT_EQ(channel->last().status(), 200);
  channel->lead_to({slower, icd::BearerToken::parse("another-token"), std::chrono::seconds{20}});
  EXPECT_TRUE(channel->turns());
  EXPECT_EQ(channel->last().status(), 0);
}

/// A Command Post whose paths need a slash at the end, or must not have one.
class TrailingSlash : public ChannelTest {
 protected:
  int status_of(icd::Uri uri) {
    int status = -1;
    channel_.send(uri, "", {}, [&](const uplink::Outcome& outcome) {
      const auto* answered = std::get_if<uplink::Answered>(&outcome);
      status = answered != nullptr ? answered->status : 0;
    });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return status >= 0; }));
    return status;
  }
  void lead_to(const uplink::Endpoint& endpoint, const char* token) {
    channel_.lead_to({endpoint, icd::BearerToken::parse(token), std::chrono::seconds{20}});
    channel_.turns();
  }

  static constexpr icd::Uri kFirst = icd::Uri::MapUpdate;
  std::atomic<bool> insists_ = true;
  std::string unknown_ = uplink::answer("404 Not Found", "\"no such URI\"");
  uplink::Peer::Script script_ = [this](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const std::string redirect = uplink::without_slash(request);
      const bool is_good = redirect.empty() == insists_;
      wire.write(is_good ? uplink::answer("200 OK", "null") : insists_ ? redirect : unknown_);
    }
  };
  uplink::ListeningPeer here_{script_}, there_{script_};
  Channel channel_{loop_,
                   servers_,
                   "mapping",
                   {here_.endpoint(), icd::BearerToken::parse("a-token"), std::chrono::seconds{20}},
                   [] {}};
};

TEST_F(TrailingSlash, IsLearntFromA301ToEachRequestExceptReports) {
  for (const icd::Uri uri : icd::kUris) {
    SCOPED_TRACE(icd::path_of(uri));
    lead_to(there_.endpoint(), "a-token");
    lead_to(here_.endpoint(), "a-token");
    EXPECT_EQ(status_of(uri), 301);
    EXPECT_EQ(status_of(uri), uri == icd::Uri::ArtifactReports ? 301 : 200);
  }
}

TEST_F(TrailingSlash, IsOfReportsAloneIfAReportIsRedirected) {
  constexpr icd::Uri kReports = icd::Uri::ArtifactReports;
  std::string paths;  // of reports: '/' with a slash at the end, '-' without
  // States want a slash, reports none. Both say so by 308.
  const uplink::ListeningPeer peer([&paths](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const bool is_report = request.starts_with("POST /api"),
                 has_slash = uplink::without_slash(request).empty();
      if (is_report) paths += has_slash ? '/' : '-';
      const std::string to = is_report ? "/api/artifact_reports" : "/state/update/";
      wire.write(has_slash != is_report
                     ? uplink::answer("200 OK", "null")
                     : uplink::answer("308 Permanent Redirect", "", "Location: " + to + "\r\n"));
    }
  });
  lead_to(peer.endpoint(), "a-token");
  EXPECT_EQ(status_of(kReports), 200);
  EXPECT_EQ(status_of(icd::Uri::StateUpdate), 308);
  EXPECT_EQ(status_of(kReports), 308);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(status_of(icd::Uri::StateUpdate), 200);
    EXPECT_EQ(status_of(kReports), 200);
  }
  EXPECT_EQ(paths, "-/--");
}

TEST_F(TrailingSlash, IsNotForeign) {
  EXPECT_EQ(status_of(kFirst), 301);
  EXPECT_FALSE(channel_.last().is_foreign());
  EXPECT_EQ(channel_.last().foreign(), 0u);
  EXPECT_THAT(channel_.trouble(), testing::HasSubstr("slash"));
  EXPECT_EQ(status_of(kFirst), 200);
  EXPECT_EQ(channel_.trouble(), "");
}

TEST_F(TrailingSlash, IsForgottenIfAPathWithItIsUnknown) {
  for (const char* unknown : {"404 Not Found", "501 Not Implemented"}) {
    SCOPED_TRACE(unknown);
    unknown_ = uplink::answer(unknown, "");
    insists_ = true;
    EXPECT_EQ(status_of(kFirst), 301);
    EXPECT_EQ(status_of(kFirst), 200);
    insists_ = false;
    EXPECT_EQ(std::to_string(status_of(kFirst)), std::string(unknown).substr(0, 3));
    EXPECT_EQ(status_of(kFirst), 200);
  }
}

TEST_F(TrailingSlash, IsForgottenAtAnotherEndpoint) {
  EXPECT_EQ(status_of(kFirst), 301);
  uplink::Endpoint slower = here_.endpoint();
  slower.connect_within = std::chrono::seconds{7};
  lead_to(slower, "a-token");
  EXPECT_EQ(status_of(kFirst), 200);
  lead_to(there_.endpoint(), "a-token");
  EXPECT_EQ(status_of(kFirst), 301);
}

/// A server with a web page in place of the status, unless its path ends with a slash.
class PageForAStatus : public TrailingSlash {
 protected:
  PageForAStatus() {
    script_ = [this](uplink::Wire& wire) {
      for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
        const bool has_slash = uplink::without_slash(request).empty();
        paths_ += has_slash ? '/' : '-';
        wire.write(has_slash ? with_slash_ : uplink::answer("200 OK", "<html>" + std::string(size_, 'x')));
      }
    };
    server_.emplace(script_);
    lead_to(server_->endpoint(), "a-token");
  }
  ~PageForAStatus() override { server_.reset(); }

  static constexpr icd::Uri kStatus = icd::Uri::Status, kReport = icd::Uri::ArtifactReports;
  std::size_t size_ = 100;
  std::string with_slash_ = uplink::answer("200 OK", kRun);
  std::string paths_;  // of the requests: '/' with a slash at the end, '-' without
  std::optional<uplink::ListeningPeer> server_;
};

/// CoSTAR's stand-in for the Command Post wants a slash and never redirects.
TEST_F(PageForAStatus, IsFollowedByATrialOfThePathWithASlash) {
  for (const std::size_t size : {100u, 20u << 10}) {
    size_ = size;
    status_of(kStatus);
    EXPECT_TRUE(channel_.has_page_for_status());
    EXPECT_TRUE(channel_.last().is_foreign());
    EXPECT_EQ(status_of(kStatus), 200);
    EXPECT_FALSE(channel_.has_page_for_status());
    EXPECT_FALSE(channel_.last().is_foreign());
    status_of(kReport);
    EXPECT_EQ(paths_, "-//");
    paths_.clear();
    lead_to(here_.endpoint(), "a-token");
    lead_to(server_->endpoint(), "a-token");
  }
}

TEST_F(PageForAStatus, StaysIfTheTrialFails) {
  for (const std::string& fails :
       {uplink::answer("200 OK", "<html>"), uplink::answer("404 Not Found", "\"no such URI\""),
        uplink::answer("501 Not Implemented", ""), uplink::answer("500 Oops", "<html>"),
        uplink::answer("429 Too Many Requests", "\"wait\""), uplink::answer("200 OK", "{}"),
        std::string("x")}) {
    SCOPED_TRACE(fails);
    with_slash_ = fails;
    for (int i = 0; i < 4; ++i) {
      status_of(kStatus);
      EXPECT_TRUE(channel_.has_page_for_status());
      EXPECT_EQ(channel_.last().status(), 200) << "of the page";
      EXPECT_TRUE(channel_.last().is_foreign());
    }
    status_of(kReport);
    EXPECT_EQ(paths_, "-/-/-");
    paths_.clear();
    lead_to(here_.endpoint(), "a-token");
    EXPECT_FALSE(channel_.has_page_for_status());
    lead_to(server_->endpoint(), "a-token");
  }
}

TEST_F(PageForAStatus, EndsIfTheTrialShowsAWrongToken) {
  with_slash_ = uplink::answer("401 Unauthorized", "\"wrong token\"");
  status_of(kStatus);
  EXPECT_EQ(status_of(kStatus), 401);
  EXPECT_FALSE(channel_.has_page_for_status());
  EXPECT_FALSE(channel_.last().is_foreign());
  EXPECT_EQ(status_of(kStatus), 401);
  EXPECT_EQ(paths_, "-//");
}

}  // namespace
}  // namespace adit::forward
