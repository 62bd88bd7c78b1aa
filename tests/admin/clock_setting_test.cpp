#include "admin/clock_setting.hpp"

#include <gmock/gmock.h>

#include "admin/fake_chronyd.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"
#include "loop/simulated_time.hpp"

namespace adit::admin {
namespace {

using namespace std::chrono_literals;
using clock::Source;
using testing::HasSubstr;

class ClockSettingTest : public testing::Test {
 protected:
  void write_status(const clock::Status& status) {
    ASSERT_TRUE(host::write_file(run_ / host::kStatusFile, codec::write_file(status), 0644));
    setting_.every_second(ntp_);
  }
  std::optional<clock::Request> asked() const {
    const auto text = host::read_file(state_ / clock::kRequestFile);
    const auto request = text ? codec::read_file<clock::Request>(*text) : std::unexpected(text.error());
    return request ? std::optional(*request) : std::nullopt;
  }
  double now() const { return loop_.wall_now(); }

  std::optional<clock::Ntp> asked_for_ntp() {
    const auto text = host::read_file(state_ / clock::kNtpFile);
    const auto ntp = text ? codec::read_file<clock::Ntp>(*text) : std::unexpected(text.error());
    return ntp ? std::optional(*ntp) : std::nullopt;
  }
  /// Simulates NTP answers: the system's clock is `behind` seconds behind the server.
  void hear(double behind) {
    chronyd_.told = {.server = 0x0a000005, .heard = now(), .behind = behind};
    const int before = chronyd_.answers;
    ASSERT_TRUE(time_.pass_until(loop_, [&] {
      setting_.every_second(ntp_);
      return chronyd_.answers > before;
    }));
    ASSERT_TRUE(time_.pass_until(loop_, [&] {
      setting_.every_second(ntp_);
      return setting_.ntp_trouble().empty() && (asked() || setting_.state().is_kept);
    }));
  }

  host::Folder state_, run_;
  loop::SimulatedTime time_;
  loop::Loop loop_;
  clock::Ntp ntp_;
  FakeChronyd chronyd_{loop_};
  ClockSetting setting_{loop_, state_.path(), run_.path(), chronyd_.port()};
};

TEST_F(ClockSettingTest, ExplainsItselfIfAditClockDoesNotRun) {
  setting_.every_second(ntp_);
  EXPECT_FALSE(setting_.state().managed);
  EXPECT_EQ(setting_.state().source, std::nullopt) << "no source is known, but the time may be right";
  EXPECT_TRUE(setting_.state().is_set);
  EXPECT_THAT(setting_.state().why, HasSubstr("adit-clock"));
  EXPECT_EQ(setting_.is_set(), std::nullopt) << "the machine manages its clock";
  EXPECT_EQ(setting_.set_clock(now()).error().status, icd::Status::Conflict);
  setting_.on_offered({Source::CommandPost, now() + 60});
  EXPECT_FALSE(asked());
}

TEST_F(ClockSettingTest, TakesTheTimeForUnsetIfTheStatusCannotBeRead) {
  run_.put(host::kStatusFile, "damaged");
  setting_.every_second(ntp_);
  EXPECT_EQ(setting_.is_set(), false) << "an alarm tells the operator";
  EXPECT_FALSE(setting_.state().is_set);
  EXPECT_THAT(setting_.state().why, HasSubstr("cannot read the status of adit-clock"));
}

TEST_F(ClockSettingTest, ReportsNoTimeAndNoTroubleWhileAditClockStarts) {
  run_.put("adit-clock.service", "");
  ClockSetting starting{loop_, state_.path(), run_.path(), chronyd_.port(), run_.path()};
  starting.every_second({.server = "10.0.0.5", .clients = ""});
  EXPECT_FALSE(starting.state().is_set) << "the clock has the time at boot";
  EXPECT_EQ(starting.state().why, "adit-clock is starting, for at most 5 minutes: try again");
  EXPECT_EQ(starting.ntp_trouble(), "");
}

TEST_F(ClockSettingTest, RequestsTheOperatorsTimeAsOfItsEntry) {
  const clock::Status status{.boot = "b"};
  write_status(status);
  EXPECT_EQ(setting_.is_set(), false);
  ASSERT_TRUE(setting_.set_clock(1.8e9));
  const auto request = asked();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->time, 1.8e9);
  EXPECT_EQ(request->source, Source::Operator);
  EXPECT_EQ(clock::refusal_reason(
                *request, std::chrono::duration<double>(loop_.now().time_since_epoch()).count(), status),
            "");
  write_status({.nonce = request->nonce, .refusal = "", .source = Source::Operator});
  EXPECT_EQ(setting_.is_set(), true);
  EXPECT_EQ(setting_.state().refusal, "");
}

TEST_F(ClockSettingTest, RejectsAnImpossibleTime) {
  write_status({});
  EXPECT_EQ(setting_.set_clock(5).error().status, icd::Status::UnprocessableEntity);
  EXPECT_FALSE(asked());
}

TEST_F(ClockSettingTest, UsesTheCommandPostsTimeOnceUnlessOperatorSetIt) {
  write_status({});
  setting_.on_offered({Source::CommandPost, now() + 600});
  const auto first = asked();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->source, Source::CommandPost);
  setting_.on_offered({Source::CommandPost, now() + 700});
  EXPECT_EQ(asked()->nonce, first->nonce) << "the request is in progress";
  ASSERT_TRUE(host::remove_file(state_ / clock::kRequestFile));
  write_status({.nonce = first->nonce, .refusal = "", .source = Source::Operator});
  setting_.on_offered({Source::CommandPost, now() + 600});
  EXPECT_FALSE(asked());
}

TEST_F(ClockSettingTest, SetsTheSystemToTheLastKnownTime) {
  write_status({});
  setting_.on_offered({Source::LastKnown, now()});
  EXPECT_FALSE(asked()) << "the system's own NTP sets the clock";
  loop_.set_wall(now() + 5000);
  setting_.on_offered({Source::LastKnown, now()});
  ASSERT_TRUE(asked());
  EXPECT_EQ(asked()->source, Source::LastKnown);
  EXPECT_NEAR(asked()->time, now(), 1);
}

TEST_F(ClockSettingTest, TellsWhyTheClockWasNotSet) {
  write_status({});
  ASSERT_TRUE(setting_.set_clock(1.8e9));
  write_status({.nonce = asked()->nonce, .refusal = "cannot set the clock: no", .source = Source::None});
  EXPECT_THAT(setting_.state().refusal, HasSubstr("cannot set the clock"));
  EXPECT_EQ(setting_.is_set(), false);
  ASSERT_TRUE(host::remove_file(state_ / clock::kRequestFile));
  setting_.on_offered({Source::CommandPost, now() + 600});
  EXPECT_FALSE(asked()) << "after a rejection the next request is a minute later";
  EXPECT_TRUE(setting_.set_clock(1.8e9));
}

TEST_F(ClockSettingTest, RetriesAnUnansweredRequest) {
  write_status({});
  setting_.on_offered({Source::CommandPost, now() + 600});
  const auto first = asked();
  ASSERT_TRUE(first);
  time_.pass(ClockSetting::kTakenUpWithin);
  setting_.every_second(ntp_);
  EXPECT_THAT(setting_.state().refusal, HasSubstr("did not read the request"));
  EXPECT_FALSE(asked()) << "the request would be too old";
  setting_.on_offered({Source::CommandPost, now() + 600});
  const auto second = asked();
  ASSERT_TRUE(second);
  EXPECT_NE(second->nonce, first->nonce);
}

TEST_F(ClockSettingTest, RetriesARejectedRequest) {
  write_status({});
  setting_.on_offered({Source::CommandPost, now() + 600});
  const auto first = asked();
  ASSERT_TRUE(first);
  ASSERT_TRUE(host::remove_file(state_ / clock::kRequestFile));
  write_status({.nonce = first->nonce,
                .refusal = "at: expected a time within the last minute",
                .source = Source::None});
  time_.pass(ClockSetting::kAskAgain - 1ms);
  setting_.on_offered({Source::CommandPost, now() + 600});
  EXPECT_FALSE(asked());
  time_.pass(1ms);
  setting_.on_offered({Source::CommandPost, now() + 600});
  ASSERT_TRUE(asked());
  EXPECT_NE(asked()->nonce, first->nonce);
}

TEST_F(ClockSettingTest, RequestsNtpPerSettingsAndAfterTheyChange) {
  write_status({});
  EXPECT_FALSE(asked_for_ntp()) << "NTP is off";
  ntp_ = {.server = "10.0.0.5", .clients = "10.0.0.0/24"};
  write_status({});
  EXPECT_EQ(asked_for_ntp(), ntp_);
  ASSERT_TRUE(host::remove_file(state_ / clock::kNtpFile));
  const clock::Status done{.ntp = ntp_};
  write_status(done);
  EXPECT_FALSE(asked_for_ntp()) << "the request was carried out";
  ntp_ = {};
  write_status(done);
  EXPECT_EQ(asked_for_ntp(), ntp_);
}

TEST_F(ClockSettingTest, TellsThatNtpNeedsAditClock) {
  setting_.every_second(ntp_);
  EXPECT_EQ(setting_.ntp_trouble(), "");
  ntp_ = {.server = "10.0.0.5", .clients = ""};
  setting_.every_second(ntp_);
  EXPECT_THAT(setting_.ntp_trouble(), HasSubstr("does not set the clock of this machine"));
  EXPECT_EQ(setting_.state().ntp, setting_.ntp_trouble());
  EXPECT_FALSE(asked_for_ntp());
}

TEST_F(ClockSettingTest, AcceptsANtpTimeWithinTheUsualBounds) {
  ntp_ = {.server = "10.0.0.5", .clients = ""};
  write_status({.source = Source::Operator, .ntp = ntp_});
  hear(7776000);
  ASSERT_TRUE(asked());
  EXPECT_EQ(asked()->source, Source::Ntp);
  EXPECT_NEAR(asked()->time, now() + 7776000, 1);
}

TEST_F(ClockSettingTest, AcceptsAnyStepFromANewNtpServer) {
  ntp_ = {.server = "10.0.0.5", .clients = ""};
  write_status({.source = Source::Ntp, .server = "10.0.0.6", .ntp = ntp_});
  setting_.on_offered({Source::CommandPost, now() + 600});
  EXPECT_FALSE(asked()) << "the earlier source is trusted like the operator";
  hear(-3600);
  ASSERT_TRUE(asked());
  EXPECT_FALSE(setting_.state().is_kept);
  EXPECT_EQ(asked()->source, Source::Ntp);
  EXPECT_EQ(asked()->server, "10.0.0.5");
  EXPECT_NEAR(asked()->time, now() - 3600, 1);
}

TEST_F(ClockSettingTest, RejectsAnImpossibleNtpTime) {
  ntp_ = {.server = "10.0.0.5", .clients = ""};
  write_status({.source = Source::None, .ntp = ntp_});
  chronyd_.told = {.server = 0x0a000005, .heard = now(), .behind = -now()};
  ASSERT_TRUE(time_.pass_until(loop_, [&] {
    setting_.every_second(ntp_);
    return chronyd_.answers > 1;  // the first answer was read
  }));
  EXPECT_FALSE(asked());
}

TEST_F(ClockSettingTest, OperatorSetsItOnlyIfNoNtpServerIsHeard) {
  ntp_ = {.server = "10.0.0.5", .clients = ""};
  write_status({.source = Source::Ntp, .server = ntp_.server, .ntp = ntp_});
  ASSERT_TRUE(setting_.set_clock(1.8e9)) << "no NTP server answers";
  write_status({.nonce = asked()->nonce, .source = Source::Ntp, .server = ntp_.server, .ntp = ntp_});
  ASSERT_TRUE(host::remove_file(state_ / clock::kRequestFile));
  hear(0.001);
  EXPECT_TRUE(setting_.state().is_kept);
  const auto refused = setting_.set_clock(1.8e9);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().status, icd::Status::Conflict);
  EXPECT_THAT(refused.error().sentence, HasSubstr("10.0.0.5 keeps the time"));
  setting_.on_offered({Source::CommandPost, now() + 600});
  EXPECT_FALSE(asked());
  ntp_ = {};
  setting_.every_second(ntp_);
  EXPECT_TRUE(setting_.set_clock(1.8e9)) << "the server is not used any more";
}

TEST_F(ClockSettingTest, IgnoresOtherAndSilentNtpServers) {
  ntp_ = {.server = "10.0.0.5", .clients = ""};
  write_status({.source = Source::Ntp, .server = ntp_.server, .ntp = ntp_});
  for (const clock::Tracking& other :
       {clock::Tracking{.server = 0x0a000006, .heard = now(), .behind = 0},
        clock::Tracking{.server = 0x0a000005, .heard = now() - NtpWatch::kSilence - 1, .behind = 0},
        clock::Tracking{}}) {
    chronyd_.told = other;
    const int before = chronyd_.answers;
    ASSERT_TRUE(time_.pass_until(loop_, [&] {
      setting_.every_second(ntp_);
      return chronyd_.answers > before + 1;
    }));
    EXPECT_FALSE(setting_.state().is_kept);
  }
}

TEST_F(ClockSettingTest, TellsWhatChronydDoesOrWhyItFails) {
  ntp_ = {.server = "", .clients = "10.0.0.0/24"};
  write_status({.source = Source::None, .ntp = ntp_, .trouble = "cannot start chronyd: no"});
  EXPECT_THAT(setting_.ntp_trouble(), HasSubstr("cannot start chronyd"));
  write_status({.source = Source::None, .ntp = ntp_});
  EXPECT_EQ(setting_.ntp_trouble(), "");
  EXPECT_EQ(setting_.state().ntp, "once the time is set, NTP gives it to 10.0.0.0/24");
  write_status({.source = Source::Operator, .ntp = ntp_});
  EXPECT_EQ(setting_.state().ntp, "NTP gives the time to 10.0.0.0/24");
}

}  // namespace
}  // namespace adit::admin
