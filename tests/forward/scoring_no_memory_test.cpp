// Memory that runs out while the answer to a report is taken: the report is recorded once all the same, and
// one knows so.
#include <gtest/gtest.h>

#include <atomic>
#include <semaphore>

#include "../uplink/peer.hpp"
#include "forward/around.hpp"
#include "forward/scoring.hpp"
#include "host/folder.hpp"
#include "loop/turn_until.hpp"
#include "scarce_memory.hpp"

namespace adit::forward {
namespace {

using dispatch::ReportState;

/// A Command Post that records every report, and lets go of a report's answer when the test says so.
struct Post {
  void serve(uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      const bool is_report = request.starts_with("POST");
      const int all = is_report ? ++recorded : recorded.load();
      if (is_report && held) let.acquire();
      const std::string run = R"(,"run_clock":10.0,"remaining_reports":)" + std::to_string(10'000 - all);
      if (!wire.write(is_report
                          ? uplink::answer(
                                "201 CREATED",
                                R"({"url":"","id":)" + std::to_string(all) +
                                    R"(,"x":1.0,"y":2.0,"z":3.0,"type":"Backpack","submitted_datetime":"",)"
                                    R"("team":"a","run":"1","report_status":"scored","score_change":1)" +
                                    run + "}")
                          : uplink::answer("200 OK", R"({"score":)" + std::to_string(all) +
                                                         R"(,"current_team":"a")" + run + "}")))
        return;
    }
  }
  std::atomic<int> recorded = 0;
  std::atomic<bool> held = false;
  std::counting_semaphore<> let{0};
};

class ScoringWithoutMemory : public testing::TestWithParam<std::size_t>, protected AroundScoring {
 protected:
  ScoringWithoutMemory() {
    settings_.command_post.rates.reports_hz = settings_.command_post.rates.status_hz = 1e9;
    settings_.command_post.scoring = {peer_.endpoint().address, peer_.endpoint().port};
    settings_.reports.doubt_for = std::chrono::milliseconds{1};
    journal_.begin({.boot = "b", .at = loop_.now(), .stamp = loop_.stamp_now()});
    live();
  }
  ~ScoringWithoutMemory() override {
    post_.held = false;
    post_.let.release(1000);
  }

  /// From what the ledger has.
  void live() {
    scoring_.reset();
    restart_ = false;
    scoring_.emplace(loop_, ledger_, settings_, icd::BearerToken::parse("a-token"), record_, random_,
                     journal_, [this] { restart_ = true; });
    ASSERT_TRUE(scoring_->start());
  }
  bool comes(const std::function<bool()>& done) {
    return loop::turn_until(loop_, [&] {
      if (restart_) live();
      scoring_->tick();
      return done();
    });
  }
  std::int64_t report(double x) {
    const auto number = scoring_->report({.type = "Backpack", .position = {x, 2, 3}}, false);
    EXPECT_TRUE(number.has_value()) << number.error();
    return number.value_or(0);
  }
  ReportState state_of(std::int64_t number) const { return scoring_->reports().book().at(number).state; }

  Post post_;
  uplink::ListeningPeer peer_{
      std::vector<uplink::Peer::Script>(1, [this](uplink::Wire& wire) { post_.serve(wire); })};
  bool restart_ = false;
  std::optional<Scoring> scoring_;
};

TEST_P(ScoringWithoutMemory, RecordsEachReportOnceAndKnowsSo) {
  ASSERT_TRUE(comes([&] { return scoring_->run().has_value(); }));
  for (std::size_t n = 0;; ++n) {
    SCOPED_TRACE(n);
    const int before = post_.recorded;
    post_.held = true;
    const std::int64_t number = report(static_cast<double>(n) * 100);
    ASSERT_TRUE(comes([&] { return post_.recorded > before; }));
    ASSERT_EQ(state_of(number), ReportState::Sending);
    post_.let.release();
    ScarceMemory scarce(n, GetParam());
    while (!restart_ && state_of(number) == ReportState::Sending && scoring_->channel().busy()) {
      loop_.turn(std::chrono::milliseconds{2});
    }
    const std::size_t failed = scarce.end();
    post_.held = false;
    ASSERT_TRUE(comes([&] {
      const ReportState state = state_of(number);
      return state == ReportState::Answered || state == ReportState::Settled;
    })) << dispatch::name_of(state_of(number));
    EXPECT_EQ(post_.recorded, before + 1);
    if (failed == 0) return;
  }
}

INSTANTIATE_TEST_SUITE_P(OnceAndAtAll, ScoringWithoutMemory,
                         testing::Values(std::size_t{1}, ScarceMemory::kAll));

}  // namespace
}  // namespace adit::forward
