#include "access/session_file.hpp"

#include <gmock/gmock.h>

#include <random>

#include "access/sessions.hpp"
#include "access/start.hpp"

namespace adit::access {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using testing::Not;

class SessionFileTest : public testing::Test {
 protected:
  Session begin(Sessions& of, Role role, Instant now) {
    Secret id{}, csrf{};
    for (auto& byte : id) byte = static_cast<std::uint8_t>(random());
    for (auto& byte : csrf) byte = static_cast<std::uint8_t>(random());
    return of.begin(id, csrf, role, {"10.0.0.5", "a \"browser\""}, now);
  }
  std::string written() const {
    return write_sessions({.boot = "boot-1", .last = sessions.last(), .sessions = sessions.in_order()});
  }
  /// Those of the file, at `now`, after a restart.
  Sessions restored(Instant now) const {
    auto kept = read_sessions(written()).value();
    Sessions after;
    after.restore(std::move(kept.sessions), kept.last, now);
    return after;
  }

  std::mt19937 random{3};
  Sessions sessions;
};

TEST_F(SessionFileTest, HoldsAllThatIsKnownOfASession) {
  const Session mine = begin(sessions, Role::Operator, kStart);
  const Session other = begin(sessions, Role::Viewer, kStart + 1ns);
  Sessions after = restored(kStart + 1h);
  const auto all = after.all(kStart + 1h);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].number, other.number);
  EXPECT_EQ(all[0].role, Role::Viewer);
  EXPECT_EQ(all[0].made, kStart + 1ns);
  EXPECT_EQ(all[1].id.reveal(), mine.id.reveal());
  EXPECT_EQ(all[1].csrf.reveal(), mine.csrf.reveal());
  EXPECT_EQ(all[1].address, "10.0.0.5");
  EXPECT_EQ(all[1].agent, "a \"browser\"");
  EXPECT_EQ(read_sessions(written())->boot, "boot-1");
}

TEST_F(SessionFileTest, GivesNobodyMoreTimeThanHeHad) {
  const Session mine = begin(sessions, Role::Operator, kStart);
  Sessions early = restored(kStart + 12h - 1s), late = restored(kStart + 12h);
  EXPECT_NE(early.find(mine.id.reveal(), kStart + 12h - 1s), nullptr);
  EXPECT_EQ(late.find(mine.id.reveal(), kStart + 12h), nullptr);
}

TEST_F(SessionFileTest, OfAClockThatHasRestartedIsForgotten) {
  const Session mine = begin(sessions, Role::Operator, kStart);
  Sessions after = restored(kStart - 1s);
  EXPECT_EQ(after.find(mine.id.reveal(), kStart - 1s), nullptr);
}

TEST_F(SessionFileTest, NeverLetsANumberBeGivenTwice) {
  begin(sessions, Role::Operator, kStart);
  const Session second = begin(sessions, Role::Operator, kStart);
  sessions.end(second.number);
  Sessions after = restored(kStart);
  EXPECT_GT(begin(after, Role::Operator, kStart).number, second.number);
}

TEST_F(SessionFileTest, IsWrittenWheneverSomebodyComesOrGoes) {
  int told = 0;
  Sessions watched([&told] { ++told; });
  const Session mine = begin(watched, Role::Operator, kStart);
  EXPECT_EQ(told, 1);
  (void)watched.find(mine.id.reveal(), kStart);
  EXPECT_EQ(told, 1) << "a look is not worth a write";
  EXPECT_FALSE(watched.end(99));
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(watched.end(mine.number));
  EXPECT_EQ(told, 2);
  watched.end_all(Role::Operator, 0);
  EXPECT_EQ(told, 3);
}

TEST_F(SessionFileTest, ThatIsNoneSaysWhyAndShowsNothingOfWhatIsInIt) {
  const Session mine = begin(sessions, Role::Operator, kStart);
  const std::string good = written();
  const auto replaced = [&good](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    return text;
  };
  for (const std::string& text : {good.substr(0, good.size() / 2), replaced("\"version\":1", "\"version\":2"),
                                  replaced("operator", "root"), replaced("\"last\":1", "\"last\":-1"),
                                  replaced("\"id\":\"", "\"id\":\"two words "), std::string("[]"),
                                  replaced("\"csrf\"", "\"crsf\""), std::string()}) {
    const auto kept = read_sessions(text);
    ASSERT_FALSE(kept.has_value()) << text;
    EXPECT_THAT(kept.error(), Not(HasSubstr(mine.id.reveal().substr(0, 16))));
  }
}

}  // namespace
}  // namespace adit::access
