#include "forward/scoring.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <semaphore>
#include <thread>

#include "../uplink/peer.hpp"
#include "forward/fixtures.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using namespace std::chrono_literals;

constexpr const char* kStatus = R"({"score":1,"run_clock":10.0,"remaining_reports":24,"current_team":"a"})";

/// Answers each request with `body` after a delay.
uplink::Peer::Script late_server(const char* body, std::chrono::milliseconds late) {
  return [body, late](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      std::this_thread::sleep_for(late);
      if (!wire.write(uplink::answer("200 OK", body))) return;
    }
  };
}

class Asker final : public intake::Responder {
 public:
  void answer(intake::Answer answer) override { heard = std::move(answer); }
  std::shared_ptr<intake::Stream> stream(std::string_view) override { return nullptr; }
  bool is_client_gone() const override { return false; }
  std::optional<intake::Answer> heard;
};

class ScoringTest : public testing::Test, protected ScoringParts {
 protected:
  /// Starts and asks for a status.
  void lead_to(std::vector<uplink::Peer::Script> scripts) {
    peer_.emplace(std::move(scripts));
    settings_.command_post.scoring = {peer_->endpoint().address, peer_->endpoint().port};
    settings_.command_post.rates.reports_hz = settings_.command_post.rates.status_hz = 1000;
    settings_.command_post.timeouts.scoring_answer = 10min;  // no timeout of Adit ends a wait
    journal_.begin({.boot = "b", .at = loop_.now(), .stamp = loop_.stamp_now()});
    scoring_.emplace(loop_, servers_, ledger_, settings_, icd::BearerToken::parse("a-token"), counts_,
                     random_, journal_, clocks_);
    scoring_->start(ledger_.runs());
  }
  bool eventually(const std::function<bool()>& done) {
    return loop::turn_until(loop_, [&] {
      scoring_->tick();
      return done();
    });
  }
  std::shared_ptr<Asker> report(double x) {
    auto client = std::make_shared<Asker>();
    scoring_->accept(icd::ArtifactReport{.type = "Backpack", .position = {x, 2, 3}},
                     intake::Sender{.address = "10.0.0.5"}, client);
    return client;
  }
  /// Answer to a client that asks before the first status has arrived.
  std::optional<intake::Answer> answer_from(uplink::Peer::Script post) {
    lead_to({std::move(post)});
    const auto asker = std::make_shared<Asker>();
    scoring_->status(asker);
    return eventually([&] { return asker->heard.has_value(); }) ? asker->heard : std::nullopt;
  }

  /// Ends both sides before the locals that the scripts use. Declare it after them.
  struct Ends {
    ScoringTest& test;
    ~Ends() { test.scoring_.reset(), test.peer_.reset(); }
  };

  std::optional<uplink::ListeningPeer> peer_;
  std::optional<Scoring> scoring_;
};

TEST_F(ScoringTest, DatesALateStatusByItsRequest) {
  const auto heard = answer_from(late_server(kStatus, 1200ms));
  ASSERT_TRUE(heard.has_value());
  EXPECT_EQ(heard->status, icd::Status::Ok);
  EXPECT_EQ(heard->body, kStatus);
  ASSERT_EQ(heard->headers.size(), 1U);
  EXPECT_EQ(heard->headers.front().name, "Age");
  EXPECT_EQ(heard->headers.front().value, "1");
}

TEST_F(ScoringTest, PassesOnNoInvalidStatus) {
  const auto heard = answer_from(late_server(R"("ok")", 0ms));
  ASSERT_TRUE(heard.has_value());
  EXPECT_EQ(heard->status, icd::Status::BadGateway);
}

constexpr const char* kRecorded =
    R"({"url":"","id":1,"x":1.0,"y":2.0,"z":3.0,"type":"Backpack","submitted_datetime":"","team":"a",)"
    R"("run":"","report_status":"scored","score_change":1,"run_clock":11.0,"remaining_reports":23})";

TEST_F(ScoringTest, CancelsAnUnansweredStatusForAReport) {
  std::atomic<bool> asked_again = false, was_reset = false;
  const auto answers_once = [&](uplink::Wire& wire) {
    wire.read_request();
    wire.write(uplink::answer("200 OK", kStatus));
    asked_again = wire.read_request().starts_with("GET");
    wire.wait_for_close();
    was_reset = wire.was_reset();
  };
  const auto records = [&](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const bool is_report = request.starts_with("POST");
      wire.write(is_report ? uplink::answer("201 CREATED", kRecorded) : uplink::answer("200 OK", kStatus));
    }
  };
  const Ends ends{*this};
  lead_to({answers_once, records});
  ASSERT_TRUE(eventually([&] { return scoring_->run().has_value(); }));
  scoring_->on_link_up();  // asks again
  ASSERT_TRUE(eventually([&] { return asked_again.load(); }));
  const auto client = report(1);
  ASSERT_TRUE(eventually([&] { return client->heard.has_value(); }));
  EXPECT_EQ(client->heard->status, icd::Status::Created);
  EXPECT_TRUE(was_reset);
}

TEST_F(ScoringTest, WaitsForAStatusThatDecidesADoubt) {
  settings_.reports.doubt_for = 100ms;
  std::atomic<int> reports = 0;
  std::atomic<bool> holds = false, is_held = false, was_waited_for = false;
  std::binary_semaphore let{0};
  const auto loses_a_report = [&](uplink::Wire& wire) {
    wire.read_request();
    wire.write(uplink::answer("200 OK", kStatus));
    if (wire.read_request().starts_with("POST")) ++reports;
  };
  const auto says_nothing_of_it = [&](uplink::Wire& wire) {
    const bool is_report = wire.read_request().starts_with("POST");
    if (is_report) ++reports;
    const bool hold = !is_report && holds.exchange(false);
    if (hold) {
      is_held = true;
      EXPECT_TRUE(let.try_acquire_for(20s));
    }
    const bool is_open =
        wire.write(is_report ? uplink::answer("201 CREATED", kRecorded) : uplink::answer("500 Error", "{}"));
    if (hold) was_waited_for = is_open;
  };
  const Ends ends{*this};
  lead_to({loses_a_report, says_nothing_of_it});
  ASSERT_TRUE(eventually([&] { return scoring_->run().has_value(); }));
  const auto lost = report(1);
  ASSERT_TRUE(eventually([&] { return reports == 1; }));
  loop::turn_for(loop_, 500ms);  // the doubt no longer blocks reports
  holds = true;
  ASSERT_TRUE(eventually([&] { return is_held.load(); }));
  const auto next = report(100);
  loop::turn_for(loop_, 3 * Scoring::kGivesWayAfter);
  EXPECT_FALSE(next->heard);
  let.release();
  EXPECT_TRUE(eventually([&] { return reports == 2; }));
  EXPECT_TRUE(was_waited_for);
}

constexpr const char* kScored =
    R"({"id":1,"run":"1","run_clock":11.0,"report_status":"scored","score_change":1})";

/// Answers requests in turn, the last answer again and again.
class InTurn {
 public:
  explicit InTurn(std::vector<std::string> answers) : answers_(std::move(answers)) {}
  std::size_t answered() const { return next_; }
  uplink::Peer::Script script() {
    return [this](uplink::Wire& wire) {
      while (!wire.read_request().empty()) {
        const std::size_t next = next_++;
        if (!wire.write(answers_[std::min(next, answers_.size() - 1)])) return;
      }
    };
  }

 private:
  const std::vector<std::string> answers_;
  std::atomic<std::size_t> next_ = 0;
};

constexpr const char* kWait = "Retry-After: 3600\r\n";

TEST_F(ScoringTest, ObeysTheRetryAfterOfA503ForAStatusThatNoReportNeeds) {
  InTurn server({uplink::answer("200 OK", kStatus), uplink::answer("503 Busy", "null", kWait)});
  const Ends ends{*this};
  lead_to({server.script()});
  ASSERT_TRUE(eventually([&] { return scoring_->run().has_value(); }));
  scoring_->on_link_up();  // asks again
  ASSERT_TRUE(eventually([&] { return scoring_->channel().last().status() == 503; }));
  const std::size_t before = server.answered();
  scoring_->on_link_up();
  loop::turn_for(loop_, 200ms);
  EXPECT_EQ(server.answered(), before);
}

TEST_F(ScoringTest, AsksForAStatusThatDecidesADoubtInThePauseOfA503) {
  settings_.reports.doubt_for = 100ms;
  InTurn server({uplink::answer("200 OK", kStatus), uplink::answer("503 Busy", "null", kWait)});
  const Ends ends{*this};
  lead_to({server.script()});
  ASSERT_TRUE(eventually([&] { return scoring_->run().has_value(); }));
  report(1);
  EXPECT_TRUE(eventually([&] { return server.answered() >= 5; }));
  EXPECT_EQ(scoring_->reports().book().at(1).state, dispatch::ReportState::InDoubt);
}

/// CoSTAR's stand-in for the Command Post has a web page at paths without a slash.
TEST_F(ScoringTest, SendsNoReportToAWebPage) {
  std::atomic<int> reports_to_pages = 0;
  std::atomic<bool> is_up = false;
  const auto stand_in = [&](uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const bool is_report = request.starts_with("POST");
      const bool is_page = !is_up || !uplink::without_slash(request).empty();
      if (is_page && is_report) ++reports_to_pages;
      wire.write(is_page     ? uplink::answer("200 OK", "<html>")
                 : is_report ? uplink::answer("201 CREATED", kRecorded)
                             : uplink::answer("200 OK", kStatus));
    }
  };
  const Ends ends{*this};
  lead_to({stand_in});
  ASSERT_TRUE(eventually([&] { return scoring_->channel().last().ended_requests() > 0; }));
  const auto client = report(1);
  ASSERT_TRUE(eventually([&] { return scoring_->channel().last().ended_requests() > 5; }));
  EXPECT_FALSE(client->heard);
  EXPECT_TRUE(scoring_->channel().last().is_foreign());
  is_up = true;
  ASSERT_TRUE(eventually([&] { return client->heard.has_value(); }));
  EXPECT_EQ(client->heard->status, icd::Status::Created);
  EXPECT_EQ(reports_to_pages, 0);
}

/// A scoring endpoint that records each report for a point, and answers each request once it may.
class Scorer {
 public:
  void may_answer(int requests) { let_.release(requests); }
  /// "S" for a status, "R" for a report.
  std::string requests() {
    const std::lock_guard lock(mutex_);
    return requests_;
  }
  uplink::Peer::Script script() {
    return [this](uplink::Wire& wire) {
      for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
        const bool is_report = request.starts_with("POST");
        note(is_report);
        let_.acquire();
        if (!wire.write(is_report ? uplink::answer("201 CREATED", kScored)
                                  : uplink::answer("200 OK", kStatus)))
          return;
      }
    };
  }

 private:
  void note(bool is_report) {
    const std::lock_guard lock(mutex_);
    requests_ += is_report ? 'R' : 'S';
  }

  std::mutex mutex_;
  std::string requests_;
  std::counting_semaphore<> let_{0};
};

TEST_F(ScoringTest, AStatusOfAClientHasReportsThatWereAnswered) {
  Scorer scorer;
  const Ends ends{*this};
  lead_to({scorer.script()});
  scorer.may_answer(2);
  ASSERT_TRUE(eventually([&] { return scoring_->run().has_value(); }));
  const auto first = report(1), second = report(100);
  ASSERT_TRUE(eventually([&] { return scorer.requests() == "SRR" && first->heard; }));
  const auto asker = std::make_shared<Asker>();
  scoring_->status(asker);
  ASSERT_TRUE(eventually([&] { return asker->heard.has_value(); }));
  EXPECT_EQ(asker->heard->status, icd::Status::Ok);
  EXPECT_EQ(asker->heard->body, R"({"score":2,"run_clock":11.0,"remaining_reports":23,"current_team":"a"})");
  EXPECT_FALSE(second->heard);
  scorer.may_answer(1000);
}

/// The count rises while the clock stands, which may be another run. The next answer names the old one.
TEST_F(ScoringTest, AStatusOfAClientHasReportsOfARunThatSeemedToBegin) {
  const char* kMore = R"({"score":1,"run_clock":10.0,"remaining_reports":25,"current_team":"a"})";
  const auto ok = [](const char* status) { return uplink::answer("200 OK", status); };
  const std::string scored = uplink::answer("201 CREATED", kScored);
  InTurn post({ok(kStatus), scored, ok(kMore), scored, uplink::answer("503 Service Unavailable", "", kWait)});
  const Ends ends{*this};
  lead_to({post.script()});
  ASSERT_TRUE(eventually([&] { return scoring_->run().has_value(); }));
  const auto first = report(1);
  ASSERT_TRUE(eventually([&] { return scoring_->run()->remaining_reports == 25; }));
  const auto second = report(100);
  ASSERT_TRUE(eventually([&] { return second->heard && post.answered() == 5; }));
  const auto asker = std::make_shared<Asker>();
  scoring_->status(asker);
  ASSERT_TRUE(eventually([&] { return asker->heard.has_value(); }));
  EXPECT_EQ(asker->heard->body, R"({"score":2,"run_clock":11.0,"remaining_reports":24,"current_team":"a"})");
}

TEST_F(ScoringTest, AStatusGoesAfterThreeReportsIfAClientAsks) {
  Scorer scorer;
  const Ends ends{*this};
  lead_to({scorer.script()});
  scorer.may_answer(1);
  ASSERT_TRUE(eventually([&] { return scoring_->run().has_value(); }));
  for (int i = 0; i < 8; ++i) report(100 * i);
  ASSERT_TRUE(eventually([&] { return scorer.requests() == "SR"; }));
  loop::turn_for(loop_, 1s);  // the status is no longer fresh
  const auto asker = std::make_shared<Asker>();
  scoring_->status(asker);
  ASSERT_TRUE(eventually([&] { return asker->heard.has_value(); }));
  scorer.may_answer(1000);
  ASSERT_TRUE(eventually([&] { return scorer.requests().size() >= 11; }));
  EXPECT_EQ(scorer.requests().substr(0, 11), "SRRRSRRRRRS") << "nobody asks for the second one";
}

}  // namespace
}  // namespace adit::forward
