#include "network/check.hpp"

#include <gmock/gmock.h>

#include "network/doubles.hpp"

namespace adit::network {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

Circumstances usual() {
  Circumstances around;
  around.command_post.scoring = {"10.100.1.200", 8000};
  around.command_post.mapping = {"10.100.1.201", 8000};
  around.listen = {{"0.0.0.0", 8000}};
  around.asker = "192.168.7.12";
  around.name = "pc-17.local";
  return around;
}

std::vector<std::string> errors(const Numbers& wanted, const Circumstances& around) {
  std::vector<std::string> sentences;
  for (const auto& error : check(wanted, numbers(), around).errors) sentences.push_back(error.sentence());
  return sentences;
}

TEST(NetworkCheck, AcceptsTheCurrentAddresses) {
  const Findings findings = check(numbers(), numbers(), usual());
  EXPECT_THAT(findings.errors, IsEmpty());
  EXPECT_THAT(findings.changes, IsEmpty());
  EXPECT_THAT(findings.warnings, IsEmpty());
}

TEST(NetworkCheck, ListsChanges) {
  const Findings findings =
      check(numbers("192.168.7.11/25", "10.100.1.10/24", "10.100.1.1"), numbers("192.168.7.10/24"), usual());
  ASSERT_THAT(findings.changes, SizeIs(3));
  EXPECT_EQ(findings.changes[0].path, "team.address");
  EXPECT_EQ(findings.changes[0].from, "192.168.7.10");
  EXPECT_EQ(findings.changes[0].to, "192.168.7.11");
  EXPECT_EQ(findings.changes[1].path, "team.prefix");
  EXPECT_EQ(findings.changes[2].path, "command_post.gateway");
  EXPECT_EQ(findings.changes[2].from, "");
  EXPECT_THAT(check(numbers(), std::nullopt, usual()).changes, SizeIs(4))
      << "all except the gateway, which stays unset";
}

TEST(NetworkCheck, RejectsAPublicTeamAddress) {
  for (const char* team : {"8.1.2.3/24", "172.32.0.1/16", "192.169.0.1/24", "100.64.0.1/24"}) {
    EXPECT_THAT(errors(numbers(team), usual()), Contains(HasSubstr(" is not a private address"))) << team;
  }
  for (const char* team : {"10.9.0.1/24", "172.16.0.1/16", "172.31.255.1/24", "192.168.0.1/24"})
    EXPECT_THAT(errors(numbers(team), usual()), IsEmpty()) << team;
  EXPECT_THAT(errors(with_mode(Mode::Dhcp), usual()), IsEmpty());
}

TEST(NetworkCheck, RejectsATeamInTheCommandPostSubnets) {
  for (const char* team : {"10.1.1.7/24", "10.2.1.7/25", "10.100.7.7/24", "10.0.0.7/8"}) {
    EXPECT_THAT(errors(numbers(team), usual()),
                ElementsAre(AllOf(HasSubstr("team.address: "),
                                  HasSubstr(" on the Command Post's side: choose another subnet"))))
        << team;
  }
  EXPECT_THAT(errors(numbers("172.16.1.7/24", "172.16.1.8/24"), usual()),
              ElementsAre(HasSubstr("172.16.1.0/24 overlaps 172.16.1.0/24 on the Command Post's side")));
  Circumstances around = usual();
  around.command_post.mapping.address = "192.168.7.201";
  EXPECT_THAT(errors(numbers(), around),
              ElementsAre(HasSubstr("192.168.7.0/24 overlaps the mapping endpoint 192.168.7.201 on")));
}

TEST(NetworkCheck, RejectsATeamInTheSubnetOfAnotherCourse) {
  Circumstances around = usual();
  around.courses = {{"A", around.command_post.scoring, around.command_post.mapping},
                    {"B", {"10.100.1.200", 8000}, {"192.168.7.201", 8000}}};
  EXPECT_THAT(
      errors(numbers(), around),
      ElementsAre(HasSubstr("192.168.7.0/24 overlaps the mapping endpoint of course B 192.168.7.201 on")));
  EXPECT_THAT(errors(numbers("192.168.8.11/24"), around), IsEmpty());
  around.allow_overlap = true;
  EXPECT_THAT(errors(numbers(), around), IsEmpty());
}

TEST(NetworkCheck, AllowsAnIntendedOverlapWithAWarning) {
  Circumstances around = usual();
  around.allow_overlap = true;
  const Findings findings = check(numbers("10.100.7.7/24"), numbers(), around);
  EXPECT_THAT(findings.errors, IsEmpty());
  EXPECT_THAT(findings.warnings, Contains("10.100.7.0/24 overlaps 10.100.0.0/16 on the Command Post's side: "
                                          "allowed, but a robot cannot reach both"));
}

TEST(NetworkCheck, WarnsIfTheClientLosesItsConnection) {
  const auto warnings = [](const char* team, const char* asker) {
    Circumstances around = usual();
    around.asker = asker;
    return check(numbers(team), numbers(), around).warnings;
  };
  EXPECT_THAT(
      warnings("192.168.8.11/24", "192.168.7.12"),
      ElementsAre(AllOf(HasSubstr("this cuts you off: your address 192.168.7.12 is not in 192.168.8.0/24"),
                        HasSubstr("open http://192.168.8.11:8000"), HasSubstr("within 90 s"))));
  EXPECT_THAT(warnings("192.168.7.99/24", "192.168.7.12"),
              ElementsAre(HasSubstr("the page moves: open http://192.168.7.99:8000")));
  EXPECT_THAT(warnings("192.168.7.11/24", "192.168.7.12"), IsEmpty()) << "the team's side does not change";
  EXPECT_THAT(warnings("192.168.8.11/24", "fd00::5"), ElementsAre(HasSubstr("cuts you off")));
}

TEST(NetworkCheck, WarnsOfUnreachableEndpoints) {
  EXPECT_THAT(check(numbers("192.168.7.11/24", "10.100.2.10/24"), numbers(), usual()).warnings,
              ElementsAre("the scoring endpoint 10.100.1.200 cannot be reached: it is in no subnet of "
                          "10.100.2.10/24, and there is no gateway",
                          "the mapping endpoint 10.100.1.201 cannot be reached: it is in no subnet of "
                          "10.100.2.10/24, and there is no gateway"));
  EXPECT_THAT(check(numbers("192.168.7.11/24", "10.100.2.10/24", "10.100.2.1"), numbers(), usual()).warnings,
              IsEmpty());
  Circumstances around = usual();
  around.command_post.scoring.address = "172.20.0.1";
  EXPECT_THAT(check(numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.1.1"), numbers(), around).warnings,
              IsEmpty())
      << "the gateway reaches all endpoints";
  Numbers both = numbers("192.168.7.11/24", "10.100.2.10/24");
  both.command_post.push_back(host("10.100.1.10/24"));
  EXPECT_THAT(check(both, numbers(), usual()).warnings, IsEmpty());
  Numbers none = numbers();
  none.command_post.clear();
  EXPECT_THAT(
      check(none, numbers(), usual()).warnings,
      Contains("the scoring endpoint 10.100.1.200 cannot be reached: the box has no address on that side"));
}

TEST(NetworkCheck, ChecksEachAddressOfTheCommandPostSide) {
  Numbers both = numbers("172.16.1.7/24");
  both.command_post.push_back(host("172.16.1.8/24"));
  EXPECT_THAT(errors(both, usual()), ElementsAre(HasSubstr("172.16.1.0/24 overlaps 172.16.1.0/24")));
  both.team = host("192.168.7.11/24");
  const auto changes = check(both, numbers(), usual()).changes;
  ASSERT_THAT(changes, SizeIs(1));
  EXPECT_EQ(changes[0].path, "command_post.addresses");
  EXPECT_EQ(changes[0].from, "10.100.1.10/24");
  EXPECT_EQ(changes[0].to, "10.100.1.10/24, 172.16.1.8/24");
}

TEST(NetworkCheck, WarnsThatABoxWithoutAFixedAddressIsFoundByName) {
  for (const Mode mode : {Mode::Dhcp, Mode::LinkLocal}) {
    const Findings findings = check(with_mode(mode), numbers(), usual());
    EXPECT_THAT(findings.errors, IsEmpty());
    EXPECT_THAT(findings.warnings,
                ElementsAre(AllOf(HasSubstr("not yet known"), HasSubstr("http://pc-17.local:8000"))));
    ASSERT_THAT(findings.changes, SizeIs(3));
    EXPECT_EQ(findings.changes[0].path, "team.mode");
    EXPECT_EQ(findings.changes[0].to, name_of(mode));
    EXPECT_EQ(findings.changes[1].to, "");
    EXPECT_THAT(check(with_mode(mode), with_mode(mode), usual()).warnings, IsEmpty());
  }
  Circumstances around = usual();
  around.listen = {{"192.168.7.11", 80}};
  EXPECT_THAT(errors(with_mode(Mode::Dhcp), around),
              ElementsAre(HasSubstr("team.mode: Adit would not be reachable")));
}

TEST(NetworkCheck, RejectsAnAddressWithoutAListener) {
  Circumstances around = usual();
  around.listen = {{"192.168.7.11", 80}};
  EXPECT_THAT(
      errors(numbers("192.168.8.11/24"), around),
      ElementsAre(HasSubstr(
          "Adit would not be reachable at 192.168.8.11: the settings' team.listen has only 192.168.7.11")));
  EXPECT_THAT(errors(numbers(), around), IsEmpty());
  EXPECT_EQ(page_at(numbers(), around.listen, around.name), "http://192.168.7.11");
}

}  // namespace
}  // namespace adit::network
