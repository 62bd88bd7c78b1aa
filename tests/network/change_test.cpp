#include "network/change.hpp"

#include <gmock/gmock.h>

#include "network/doubles.hpp"

namespace adit::network {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Records its calls, and fails if the test says so. A failed change may be in use nevertheless.
struct FakeNumbersSetter final : NumbersSetter {
  std::expected<void, std::string> apply(const Numbers& all) override {
    in_use = host_text(all.team);
    return did("apply " + in_use, fail_apply);
  }
  std::expected<void, std::string> keep(const Numbers& all) override {
    if (!fail_keep) kept = host_text(all.team);
    return did("keep " + host_text(all.team), fail_keep);
  }
  std::expected<void, std::string> revert() override {
    const bool fails = fail_revert > 0 && fail_revert-- > 0;
    if (!fails) in_use = kept;
    return did("revert", fails);
  }
  std::expected<std::optional<Numbers>, std::string> forget() override {
    const auto done_so = did("forget", fail_keep);
    if (!done_so) return std::unexpected(done_so.error());
    in_use = kept = "10.0.0.1/24";
    return numbers(kept);
  }
  std::expected<void, std::string> did(const std::string& what, bool fails) {
    done.push_back(what);
    if (fails) return std::unexpected("the disk is full");
    return {};
  }
  std::vector<std::string> done;
  std::string in_use = "192.168.7.11/24", kept = in_use;
  bool fail_apply = false, fail_keep = false;
  int fail_revert = 0;
};

class ChangeTest : public testing::Test {
 protected:
  static constexpr const char* kNew = "192.168.8.11/24";
  const std::string nonce = std::string(32, 'a'), other = std::string(32, 'b');

  void request_change(const std::string& team = kNew) {
    change.request_change({nonce, seconds(90), numbers(team)}, at(0));
  }
  static Instant at(double s) { return Instant(milliseconds(static_cast<std::int64_t>(1e6 + s * 1000))); }
  void confirm(double s) { change.decide({nonce, Decision::Command::Confirm}, at(s)); }

  FakeNumbersSetter hands;
  Change change{hands, numbers()};
};

TEST_F(ChangeTest, IsAppliedAtOnceAndPendingUntilItsDeadline) {
  request_change();
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24"));
  ASSERT_TRUE(change.status().pending);
  EXPECT_EQ(change.status().pending->until, at(90));
  EXPECT_EQ(change.wake(), at(90));
  EXPECT_EQ(change.status().kept, numbers()) << "unchanged until the confirmation";
  EXPECT_EQ(change.status().ended, ChangeOutcome::NotYet);
}

TEST_F(ChangeTest, IsStoredOnceConfirmed) {
  request_change();
  confirm(89.999);
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "keep 192.168.8.11/24"));
  EXPECT_FALSE(change.status().pending);
  EXPECT_EQ(change.status().ended, ChangeOutcome::Confirmed);
  EXPECT_EQ(change.status().kept, numbers(kNew));
  EXPECT_EQ(change.wake(), std::nullopt);
  change.tick(at(1000));
  EXPECT_EQ(hands.done.size(), 2u) << "no further step";
}

TEST_F(ChangeTest, IsRevertedAtItsDeadline) {
  request_change();
  change.tick(at(89.999));
  EXPECT_TRUE(change.status().pending);
  change.tick(at(90));
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "revert"));
  EXPECT_FALSE(change.status().pending);
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
  EXPECT_EQ(change.status().why, "the change was not confirmed within 90 s");
  EXPECT_EQ(change.status().kept, numbers());
}

TEST_F(ChangeTest, RejectsALateConfirmation) {
  request_change();
  change.tick(at(90));
  confirm(90);
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "revert"));
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
}

TEST_F(ChangeTest, AcceptsAConfirmationReadLate) {
  request_change();
  confirm(94);
  change.tick(at(94));
  EXPECT_EQ(change.status().ended, ChangeOutcome::Confirmed);
}

TEST_F(ChangeTest, IsConfirmedOnlyByItsNonce) {
  request_change();
  change.decide({other, Decision::Command::Confirm}, at(1));
  change.decide({other, Decision::Command::Revert}, at(1));
  EXPECT_TRUE(change.status().pending);
  EXPECT_EQ(hands.done.size(), 1u);
}

TEST_F(ChangeTest, IsRevertedOnRequest) {
  request_change();
  change.decide({nonce, Decision::Command::Revert}, at(1));
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "revert"));
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
  EXPECT_EQ(change.status().ended_nonce, nonce);
}

TEST_F(ChangeTest, IsRevertedAtAStop) {
  change.stop(at(0));
  EXPECT_THAT(hands.done, IsEmpty());
  request_change();
  change.stop(at(1));
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "revert"));
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
}

TEST_F(ChangeTest, RetriesARevertAtAStop) {
  hands.fail_revert = 1;
  request_change();
  change.tick(at(90));
  change.stop(at(91));
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "revert", "revert"));
  EXPECT_EQ(change.status().why, "the change was not confirmed within 90 s");
}

TEST_F(ChangeTest, IsRevertedAtOnceIfItCannotBeApplied) {
  hands.fail_apply = true;
  request_change();
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "revert"));
  EXPECT_FALSE(change.status().pending);
  EXPECT_EQ(change.status().why, "the change could not be applied: the disk is full");
}

TEST_F(ChangeTest, IsRevertedIfItCannotBeStored) {
  hands.fail_keep = true;
  request_change();
  confirm(1);
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "keep 192.168.8.11/24", "revert"));
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
  EXPECT_EQ(change.status().kept, numbers());
  EXPECT_THAT(change.status().why, HasSubstr("could not be stored: the disk is full"));
}

TEST_F(ChangeTest, RetriesARevertUntilItSucceeds) {
  hands.fail_revert = 2;
  request_change();
  change.tick(at(90));
  EXPECT_TRUE(change.status().pending) << "the change is still in use";
  EXPECT_EQ(change.wake(), at(92));
  confirm(91);
  EXPECT_TRUE(change.status().pending) << "too late";
  change.tick(at(92));
  change.tick(at(94));
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "revert", "revert", "revert"));
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
  EXPECT_EQ(change.wake(), std::nullopt);
}

TEST_F(ChangeTest, IsGivenUpIfItCannotBeReverted) {
  hands.fail_revert = 99;
  request_change();
  for (double s = 90; s < 200; s += 1) change.tick(at(s));
  EXPECT_EQ(hands.done.size(), 1u + Change::kTries);
  EXPECT_FALSE(change.status().pending);
  EXPECT_THAT(change.status().why, HasSubstr("retrying: the disk is full"));
}

TEST_F(ChangeTest, IsNotReplacedWhilePending) {
  request_change();
  change.request_change({other, seconds(90), numbers("192.168.9.11/24")}, at(10));
  EXPECT_EQ(hands.done.size(), 1u);
  EXPECT_EQ(change.status().pending->nonce, nonce);
  EXPECT_EQ(change.wake(), at(90)) << "the trial must not last longer";
}

TEST_F(ChangeTest, ToTheSameAddressTouchesNothing) {
  request_change("192.168.7.11/24");
  EXPECT_THAT(hands.done, IsEmpty());
  EXPECT_EQ(change.status().ended, ChangeOutcome::Confirmed);
  EXPECT_EQ(change.status().ended_nonce, nonce);
}

TEST_F(ChangeTest, MayFollowAnother) {
  request_change();
  confirm(1);
  change.request_change({other, seconds(10), numbers("192.168.9.11/24")}, at(5));
  change.tick(at(15));
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "keep 192.168.8.11/24",
                                      "apply 192.168.9.11/24", "revert"));
  EXPECT_EQ(change.status().kept, numbers(kNew)) << "the confirmed addresses";
}

TEST(FirstChange, IsRevertedToNothing) {
  FakeNumbersSetter hands;
  Change change(hands, std::nullopt);
  change.on_interrupted();
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
  const Instant now{};
  change.request_change({std::string(32, 'c'), seconds(1), numbers()}, now);
  EXPECT_EQ(change.status().kept, std::nullopt);
  change.tick(now + seconds(1));
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.7.11/24", "revert"));
}

TEST_F(ChangeTest, IsForgottenWithConfirmedAddresses) {
  change.set_endpoints({{1, 2}});
  request_change();
  EXPECT_TRUE(change.forget(at(1)));
  EXPECT_FALSE(change.status().pending);
  EXPECT_EQ(change.wake(), std::nullopt);
  EXPECT_EQ(change.status().ended, ChangeOutcome::Reverted);
  EXPECT_EQ(change.status().why, "a factory reset forgot all addresses");
  EXPECT_EQ(change.status().kept, numbers("10.0.0.1/24"));
  EXPECT_EQ(change.status().endpoints, Endpoints{});
  EXPECT_THAT(hands.done, ElementsAre("apply 192.168.8.11/24", "forget"));
}

TEST_F(ChangeTest, IsRevertedIfForgettingFails) {
  hands.fail_keep = true;
  request_change();
  EXPECT_EQ(change.forget(at(1)).error(), "the disk is full");
  EXPECT_EQ(change.status().why, "a factory reset forgets all addresses")
      << "a confirmation is no longer possible";
  EXPECT_EQ(change.status().kept, numbers());
}

/// Whatever the order of events, finally only addresses that were confirmed in time are in use.
TEST(Changes, LeaveNoUnconfirmedAddressInUse) {
  std::uint64_t random = 1;
  const auto draw = [&random](std::uint64_t most) {
    random = random * 6364136223846793005u + 1442695040888963407u;
    return (random >> 33) % most;
  };
  for (int round = 0; round < 2000; ++round) {
    FakeNumbersSetter hands;
    Change change(hands, numbers());
    std::string confirmed = "192.168.7.11/24";
    Instant now{};
    for (int step = 0; step < 12; ++step) {
      now += milliseconds(draw(1500));
      hands.fail_apply = draw(8) == 0;
      hands.fail_keep = draw(8) == 0;
      const std::string nonce(32, static_cast<char>('0' + draw(3)));
      const std::string team = "192.168." + std::to_string(20 + draw(3)) + ".11/24";
      const auto before = change.status().pending;
      const bool is_open = before && change.wake() == before->until;  // and is not being reverted
      switch (draw(4)) {
        case 0:
          change.request_change({nonce, seconds(1), numbers(team)}, now);
          break;
        case 1:
          change.decide({nonce, Decision::Command::Confirm}, now);
          if (is_open && before->nonce == nonce && !hands.fail_keep) {
            confirmed = host_text(before->wanted.team);
          }
          break;
        case 2:
          change.decide({nonce, Decision::Command::Revert}, now);
          break;
        default:
          change.tick(now);
      }
    }
    change.tick(now + seconds(1));
    EXPECT_FALSE(change.status().pending);
    EXPECT_EQ(hands.kept, confirmed);
    EXPECT_EQ(hands.in_use, confirmed);
    EXPECT_EQ(host_text(change.status().kept->team), confirmed);
  }
}

}  // namespace
}  // namespace adit::network
