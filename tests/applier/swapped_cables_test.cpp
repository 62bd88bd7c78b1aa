#include <gmock/gmock.h>

#include "applier/conflict_detector.hpp"
#include "host/folder.hpp"
#include "host/root_program.hpp"
#include "loop/simulated_time.hpp"
#include "network/messages.hpp"

namespace adit::applier {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Mac kOurs = {2, 0, 0, 0, 0, 1}, kPost = {2, 0, 0, 0, 0, 7};
constexpr std::uint32_t kScoring = 0x0a6401c8, kMapping = 0x0a6401c9;  // 10.100.1.200, .201

ArpPacket from(std::uint32_t address, const Mac& sender = kPost) {
  return {.asks = false, .sender = sender, .from = address, .about = 0};
}

class ExchangedCablesTest : public testing::Test {
 protected:
  ExchangedCablesTest() { exchanged.set_sought({kScoring, kMapping}, {kOurs}, now); }

  /// Passes time. Hosts that are present answer requests.
  void pass(seconds time, bool is_at_team, bool is_at_post) {
    for (const auto until = now + time; now < until; now += seconds(1)) {
      const SwappedCables::DueProbes due = exchanged.pop_due(now);
      asked_at_post += due.at_post.size();
      for (const std::uint32_t address : due.at_team) {
        if (is_at_team) exchanged.on_team_packet(from(address), now);
      }
      for (const std::uint32_t address : due.at_post) {
        if (is_at_post) exchanged.on_command_post_packet(from(address), now);
      }
    }
  }
  std::vector<std::uint32_t> found() const {
    std::vector<std::uint32_t> all;
    for (const ConflictDetector::Conflict& each : exchanged.conflicts(now)) all.push_back(each.address);
    return all;
  }

  SwappedCables::Instant now{std::chrono::hours(1)};
  SwappedCables exchanged;
  std::size_t asked_at_post = 0;
};

TEST_F(ExchangedCablesTest, AreFoundIfTheCommandPostAnswersOnlyAtTheTeamPort) {
  pass(seconds(10), true, false);
  EXPECT_THAT(found(), ElementsAre(kScoring, kMapping));
  pass(std::chrono::minutes(5), true, false);
  EXPECT_THAT(found(), ElementsAre(kScoring, kMapping)) << "as long as the cables are exchanged";
  pass(network::kTakenFor + seconds(6), false, true);
  EXPECT_THAT(found(), IsEmpty());
}

TEST_F(ExchangedCablesTest, AreNotFoundIfItAnswersAtItsOwnPort) {
  pass(std::chrono::minutes(2), false, true);
  EXPECT_THAT(found(), IsEmpty());
  EXPECT_EQ(asked_at_post, 0u) << "no requests on that side without a cause";
  exchanged.restart_probing(now);
  pass(std::chrono::minutes(2), true, true);
  EXPECT_THAT(found(), IsEmpty()) << "both cables are in one network, or a host answers falsely";
}

TEST_F(ExchangedCablesTest, AreNotFoundAfterASinglePacket) {
  pass(std::chrono::minutes(1), false, false);
  exchanged.on_team_packet(from(kScoring), now);
  for (seconds waited(0); waited < network::kTakenFor; waited += seconds(1)) {
    EXPECT_THAT(found(), IsEmpty());
    pass(seconds(1), false, false);
  }
  EXPECT_THAT(found(), IsEmpty());
}

TEST_F(ExchangedCablesTest, IgnorePacketsOfThisMachine) {
  for (int i = 0; i < 60; ++i) {
    exchanged.on_team_packet(from(kScoring, kOurs), now);
    pass(seconds(1), false, false);
  }
  EXPECT_THAT(found(), IsEmpty());
}

TEST_F(ExchangedCablesTest, AreSoughtAgainWhenACableComes) {
  pass(std::chrono::minutes(2), false, false);
  EXPECT_EQ(exchanged.wake(), std::nullopt) << "requests must have ended";
  exchanged.restart_probing(now);
  pass(seconds(10), true, false);
  EXPECT_THAT(found(), ElementsAre(kScoring, kMapping));
}

TEST_F(ExchangedCablesTest, LimitProbesAtTheCommandPostPort) {
  pass(std::chrono::minutes(1), false, false);
  asked_at_post = 0;
  const auto began = now;
  for (; now < began + std::chrono::minutes(1); now += std::chrono::milliseconds(10)) {
    exchanged.on_team_packet(from(kScoring), now);
    asked_at_post += exchanged.pop_due(now).at_post.size();
  }
  EXPECT_LE(asked_at_post,
            static_cast<std::size_t>(std::chrono::minutes(1) / ConflictDetector::kBetween) + 1);
}

settings::Subnet subnet(const char* text) {
  return settings::parse_subnet(text).value();
}

network::Status status(const char* gateway = nullptr) {
  network::Status status;
  status.kept =
      network::Numbers{.team = subnet("192.168.7.11/24"), .command_post = {subnet("10.100.1.10/24")}};
  if (gateway != nullptr) status.kept->gateway = settings::ipv4_of(gateway);
  status.endpoints.addresses = {kScoring, kMapping, 0x0a640501, 0x0a640502};
  return status;
}

TEST(SoughtAddresses, AreEndpointsOnTheLinkAndTheGateway) {
  const std::vector team = {subnet("192.168.7.11/24")};
  EXPECT_THAT(sought_in(status(), {}, team), ElementsAre(kScoring, kMapping));
  EXPECT_THAT(sought_in(status("10.100.1.1"), {}, team), ElementsAre(0x0a640101u, kScoring, kMapping));
  EXPECT_THAT(sought_in({}, {}, team), IsEmpty());
}

TEST(StatusReader, StaysTheLastOneWhileTheFileCannotBeRead) {
  const host::Folder folder;
  loop::SimulatedTime time;
  loop::Loop loop;
  int changes = 0;
  StatusReader told(loop, folder.path(), [&] { ++changes; });
  EXPECT_THAT(told.read().endpoints.addresses, IsEmpty());
  folder.put(host::kStatusFile, codec::write_file(status()));
  EXPECT_EQ(told.read(), status());
  folder.put(host::kStatusFile, "damaged");
  EXPECT_EQ(told.read(), status()) << "the endpoints are sought on";
  EXPECT_TRUE(time.pass_until(
      loop, [&] { return changes > 0; }, std::chrono::seconds(11)))
      << "it is read again";
}

TEST(SoughtAddresses, FollowTheBoxsAddressesIfNoneIsSet) {
  network::Status other = status();
  other.kept.reset();
  EXPECT_THAT(sought_in(other, {subnet("10.100.1.10/24")}, {}), ElementsAre(kScoring, kMapping));
  EXPECT_THAT(sought_in(other, {}, {}), IsEmpty());
}

TEST(SoughtAddresses, ExcludeAddressesInOverlappingNetworks) {
  EXPECT_THAT(sought_in(status(), {}, {subnet("169.254.3.4/16"), subnet("10.100.1.11/24")}), IsEmpty());
}

TEST(SoughtAddresses, AreBounded) {
  network::Status many = status();
  many.endpoints.addresses.clear();
  for (std::uint32_t i = 0; i < network::kMostEndpoints; ++i)
    many.endpoints.addresses.push_back(0x0a640120 + i);
  EXPECT_EQ(sought_in(many, {}, {}).size(), ConflictDetector::kMost);
}

}  // namespace
}  // namespace adit::applier
