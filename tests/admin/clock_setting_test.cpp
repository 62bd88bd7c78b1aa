#include "admin/clock_setting.hpp"

#include <gmock/gmock.h>

#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::admin {
namespace {

using clock::Source;
using testing::HasSubstr;

class ClockSettingTest : public testing::Test {
 protected:
  void say(const clock::Status& status) {
    ASSERT_TRUE(host::write_file(run_ / clock::kStatusFile, clock::write(status), 0644));
    setting_.every_second();
  }
  std::optional<clock::Request> asked() const {
    const auto text = host::read_file(state_ / clock::kRequestFile);
    const auto request = text ? clock::read<clock::Request>(*text) : std::unexpected(text.error());
    return request ? std::optional(*request) : std::nullopt;
  }
  double now() const { return loop_.wall_now(); }

  host::Folder state_, run_;
  loop::Loop loop_;
  ClockSetting setting_{loop_, state_.path(), run_.path()};
};

TEST_F(ClockSettingTest, SaysWhyItCannotSetTheClockWhereAditClockDoesNotRun) {
  setting_.every_second();
  EXPECT_FALSE(setting_.clock().managed);
  EXPECT_THAT(setting_.clock().why, HasSubstr("adit-clock"));
  EXPECT_EQ(setting_.is_set(), std::nullopt) << "the machine's own affair";
  EXPECT_EQ(setting_.set_clock(now()).error().status, icd::Status::Conflict);
  setting_.offered({Source::CommandPost, now() + 60});
  EXPECT_FALSE(asked());
}

TEST_F(ClockSettingTest, AsksForTheOperatorsTimeAsOfThatInstant) {
  say({});
  EXPECT_EQ(setting_.is_set(), false);
  ASSERT_TRUE(setting_.set_clock(1.8e9));
  const auto request = asked();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->time, 1.8e9);
  EXPECT_EQ(request->source, Source::Operator);
  EXPECT_EQ(clock::hindrance(*request, std::chrono::duration<double>(loop_.now().time_since_epoch()).count()),
            "");
  say({.nonce = request->nonce, .refusal = "", .source = Source::Operator});
  EXPECT_EQ(setting_.is_set(), true);
  EXPECT_EQ(setting_.clock().refusal, "");
}

TEST_F(ClockSettingTest, RefusesATimeThatNoBoxCanHave) {
  say({});
  EXPECT_EQ(setting_.set_clock(5).error().status, icd::Status::UnprocessableEntity);
  EXPECT_FALSE(asked());
}

TEST_F(ClockSettingTest, TakesTheCommandPostsTimeOnceAndNotOverTheOperators) {
  say({});
  setting_.offered({Source::CommandPost, now() + 600});
  const auto first = asked();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->source, Source::CommandPost);
  setting_.offered({Source::CommandPost, now() + 700});
  EXPECT_EQ(asked()->nonce, first->nonce) << "it is being set";
  ASSERT_TRUE(host::remove_file(state_ / clock::kRequestFile));
  say({.nonce = first->nonce, .refusal = "", .source = Source::Operator});
  setting_.offered({Source::CommandPost, now() + 600});
  EXPECT_FALSE(asked());
}

TEST_F(ClockSettingTest, BringsTheSystemToTheLastTimeKnown) {
  say({});
  setting_.offered({Source::LastKnown, now()});
  EXPECT_FALSE(asked()) << "the system's own";
  loop_.set_wall(now() + 5000);
  setting_.offered({Source::LastKnown, now()});
  ASSERT_TRUE(asked());
  EXPECT_EQ(asked()->source, Source::LastKnown);
  EXPECT_NEAR(asked()->time, now(), 1);
}

TEST_F(ClockSettingTest, TellsWhyItWasNotSet) {
  say({});
  ASSERT_TRUE(setting_.set_clock(1.8e9));
  say({.nonce = asked()->nonce, .refusal = "the clock cannot be set: no", .source = Source::None});
  EXPECT_THAT(setting_.clock().refusal, HasSubstr("cannot be set"));
  EXPECT_EQ(setting_.is_set(), false);
  ASSERT_TRUE(host::remove_file(state_ / clock::kRequestFile));
  setting_.offered({Source::CommandPost, now() + 600});
  EXPECT_FALSE(asked()) << "it would be refused again, each second";
  EXPECT_TRUE(setting_.set_clock(1.8e9));
}

}  // namespace
}  // namespace adit::admin
