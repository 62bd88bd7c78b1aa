// The setting of the scoring endpoint changes while reports are in flight and queued.
#include <gmock/gmock.h>

#include <atomic>
#include <semaphore>

#include "../uplink/peer.hpp"
#include "forward/fixtures.hpp"
#include "forward/scoring.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;

/// Collects the statuses of answers.
class Client final : public intake::Responder {
 public:
  explicit Client(std::vector<int>& told) : told_(told) {}
  void answer(intake::Answer answer) override { told_.push_back(static_cast<int>(answer.status)); }
  std::shared_ptr<intake::Stream> stream(std::string_view) override { return nullptr; }
  bool is_client_gone() const override { return false; }

 private:
  std::vector<int>& told_;
};

/// Records each report and answers it once `let` is released.
class ScoringStub {
 public:
  ~ScoringStub() { let.release(1000); }
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }

  std::atomic<int> recorded = 0, reports = 0, reports_with_slash = 0;
  std::atomic<bool> wants_slash = false, reports_want_slash = false, is_unprocessed = false;
  std::counting_semaphore<> let{0};

 private:
  void serve(uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const bool is_report = request.starts_with("POST");
      std::string redirect = uplink::without_slash(request);
      if (is_unprocessed && !redirect.empty())
        redirect.replace(redirect.find("301 Moved Permanently"), 21, "307 Temporary Redirect");
      if (is_report) ++reports;
      if (is_report && redirect.empty()) ++reports_with_slash;
      if (!redirect.empty() && (is_report ? reports_want_slash : wants_slash)) {
        if (!wire.write(redirect)) return;
        continue;
      }
      const int all = is_report ? ++recorded : recorded.load();
      if (is_report) let.acquire();
      const std::string run = R"(,"run_clock":10.0,"remaining_reports":)" + std::to_string(100 - all);
      if (!wire.write(
              is_report
                  ? uplink::answer("201 CREATED",
                                   R"({"url":"","id":1,"x":1.0,"y":2.0,"z":3.0,"type":"Backpack",)"
                                   R"("submitted_datetime":"","team":"a","run":"","report_status":"scored",)"
                                   R"("score_change":1)" +
                                       run + "}")
                  : uplink::answer("200 OK", R"({"score":)" + std::to_string(all) + R"(,"current_team":"a")" +
                                                 run + "}")))
        return;
    }
  }
  uplink::ListeningPeer peer_{
      std::vector<uplink::Peer::Script>(1, [this](uplink::Wire& wire) { serve(wire); })};
};

class ScoringEndpoint : public testing::Test, protected ScoringParts {
 protected:
  ScoringEndpoint() {
    settings_.command_post.rates.reports_hz = settings_.command_post.rates.status_hz = 1000;
    settings_.command_post.scoring = here_.address();
    journal_.begin({.boot = "b", .at = loop_.now(), .stamp = loop_.stamp_now()});
    scoring_.emplace(loop_, servers_, ledger_, settings_, token_, counts_, random_, journal_, clocks_);
    scoring_->start(ledger_.runs());
    EXPECT_TRUE(eventually([this] { return scoring_->run().has_value(); }));
  }

  bool eventually(const std::function<bool()>& done) {
    return loop::turn_until(loop_, [&] {
      scoring_->tick();
      return done();
    });
  }
  void post(double x, std::vector<int>& told) {
    scoring_->accept(icd::ArtifactReport{.type = "Backpack", .position = {x, 2, 3}},
                     intake::Sender{.address = "10.0.0.5"}, std::make_shared<Client>(told));
  }
  void move() {
    settings_.command_post.scoring = there_.address();
    scoring_->on_endpoint_changed(token_);
    scoring_->on_settings_changed();
  }
  const dispatch::Report& report(std::int64_t number) const { return scoring_->reports().book().at(number); }

  const std::optional<icd::BearerToken> token_ = icd::BearerToken::parse("a-token");
  ScoringStub here_, there_;
  std::vector<int> first_, second_;
  std::optional<Scoring> scoring_;
};

TEST_F(ScoringEndpoint, IsLeftAfterTheAnswerInFlight) {
  post(1, first_);
  ASSERT_TRUE(eventually([this] { return here_.recorded == 1; }));
  move();
  const auto run = report(1).run;
  loop::turn_for(loop_, std::chrono::milliseconds{50});
  EXPECT_THAT(first_, testing::IsEmpty());
  here_.let.release();
  ASSERT_TRUE(eventually([this] { return !first_.empty(); }));
  EXPECT_THAT(first_, ElementsAre(201));
  EXPECT_EQ(report(1).state, dispatch::ReportState::Answered);
  EXPECT_EQ(report(1).run, run);
  ASSERT_TRUE(
      eventually([&] { return scoring_->reports().run().number != run && scoring_->run().has_value(); }));
  post(100, second_);
  there_.let.release();
  ASSERT_TRUE(eventually([this] { return !second_.empty(); }));
  EXPECT_THAT(second_, ElementsAre(201));
  EXPECT_EQ(here_.recorded, 1);
  EXPECT_EQ(there_.recorded, 1);
}

TEST_F(ScoringEndpoint, KeepsItsQueuedReportsAndTheirClients) {
  post(1, first_);
  ASSERT_TRUE(eventually([this] { return here_.recorded == 1; }));
  post(100, second_);
  move();
  here_.let.release();
  ASSERT_TRUE(eventually([this] { return !first_.empty() && scoring_->run().has_value(); }));
  loop::turn_for(loop_, std::chrono::milliseconds{100});
  EXPECT_THAT(second_, testing::IsEmpty());
  EXPECT_EQ(there_.recorded, 0) << "it belongs to the run of the old endpoint";
  settings_.command_post.scoring = here_.address();
  scoring_->on_endpoint_changed(token_);
  here_.let.release();
  ASSERT_TRUE(eventually([this] { return !second_.empty(); }));
  EXPECT_THAT(second_, ElementsAre(201));
}

TEST_F(ScoringEndpoint, GetsReportsPostedAfterItsChange) {
  post(1, first_);
  ASSERT_TRUE(eventually([this] { return here_.recorded == 1; }));
  move();
  post(100, second_);
  there_.let.release();
  here_.let.release();
  ASSERT_TRUE(eventually([this] { return !second_.empty(); }));
  EXPECT_THAT(second_, ElementsAre(201));
  EXPECT_EQ(here_.recorded, 1);
  EXPECT_EQ(there_.recorded, 1);
}

TEST_F(ScoringEndpoint, KeepsItsRunWithAnotherToken) {
  const auto run = scoring_->reports().run().number;
  scoring_->on_endpoint_changed(std::nullopt);
  EXPECT_FALSE(scoring_->channel().has_token());
  post(1, first_);
  EXPECT_THAT(first_, testing::IsEmpty()) << "queued";
  scoring_->on_endpoint_changed(token_);
  here_.let.release();
  ASSERT_TRUE(eventually([this] { return !first_.empty(); }));
  EXPECT_THAT(first_, ElementsAre(201));
  EXPECT_EQ(report(1).run, run);
}

TEST_F(ScoringEndpoint, GetsAReportWithTheSlashOfItsStatus) {
  there_.wants_slash = there_.reports_want_slash = true;
  move();
  ASSERT_TRUE(eventually([&] {
    return scoring_->channel().address() == address_text(there_.address()) && scoring_->run().has_value();
  }));
  post(1, first_);
  there_.let.release();
  ASSERT_TRUE(eventually([this] { return !first_.empty(); }));
  EXPECT_THAT(first_, ElementsAre(201));
  EXPECT_EQ(there_.reports, 1);
}

TEST_F(ScoringEndpoint, SendsARedirectedReportAtTheOtherFormOfItsPath) {
  here_.reports_want_slash = here_.is_unprocessed = true;
  post(1, first_);
  here_.let.release();
  ASSERT_TRUE(eventually([this] { return !first_.empty(); }));
  EXPECT_THAT(first_, ElementsAre(201));
  EXPECT_EQ(here_.reports, 2);
  EXPECT_EQ(here_.recorded, 1);
  EXPECT_EQ(report(1).tries, 0) << "it was not in doubt";
}

TEST_F(ScoringEndpoint, SendsNoReportByARedirect) {
  settings_.reports.doubt_for = std::chrono::milliseconds{100};
  settings_.reports.doubt_asks = 1;
  scoring_->on_settings_changed();
  here_.reports_want_slash = true;
  post(1, first_);
  ASSERT_TRUE(eventually([this] { return here_.reports == 1; }));
  ASSERT_TRUE(eventually([this] { return here_.reports > 1; })) << "retried after a status";
  EXPECT_EQ(here_.reports_with_slash, 0);
  EXPECT_EQ(here_.recorded, 0);
}

}  // namespace
}  // namespace adit::forward
