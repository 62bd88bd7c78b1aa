#include "access/sessions.hpp"

#include <gmock/gmock.h>

#include <random>
#include <set>

#include "access/start.hpp"

namespace adit::access {
namespace {

using namespace std::chrono_literals;

Secret secret(std::mt19937_64& random) {
  Secret secret;
  for (auto& byte : secret) byte = static_cast<std::uint8_t>(random());
  return secret;
}

class SessionsTest : public testing::Test {
 protected:
  Session begin(Role role, Instant now, const std::string& agent = "browser") {
    return sessions.begin(secret(random), secret(random), role, {"10.0.0.5", agent}, now);
  }
  bool lives(const Session& session, Instant now) {
    return sessions.find(session.id.reveal(), now) != nullptr;
  }

  std::mt19937_64 random{7};
  Sessions sessions;
};

TEST(Secrets, AreWrittenInHexadecimal) {
  Secret secret{};
  secret[0] = 0x0f;
  secret[31] = 0xa0;
  EXPECT_EQ(to_token(secret).reveal(), "0f" + std::string(60, '0') + "a0");
}

TEST_F(SessionsTest, AreFoundOnlyByTheirId) {
  const Session mine = begin(Role::Operator, kStart);
  const Session* const found = sessions.find(mine.id.reveal(), kStart);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(found->role, Role::Operator);
  EXPECT_EQ(found->address, "10.0.0.5");
  for (const std::string& other :
       {std::string(), std::string("1"), mine.csrf.reveal(), mine.id.reveal() + "0",
        mine.id.reveal().substr(1), std::string(64, '0')}) {
    EXPECT_EQ(sessions.find(other, kStart), nullptr) << other;
  }
}

TEST_F(SessionsTest, EndAfterTwelveIdleHours) {
  const Session session = begin(Role::Viewer, kStart);
  EXPECT_TRUE(lives(session, kStart + 12h - 1s));
  EXPECT_TRUE(lives(session, kStart + 23h)) << "use extends the session";
  EXPECT_FALSE(lives(session, kStart + 35h));
  EXPECT_FALSE(lives(session, kStart + 35h)) << "the session has ended for good";
}

TEST_F(SessionsTest, EndAfterSevenDays) {
  const Session session = begin(Role::Operator, kStart);
  for (auto age = 1h; age < 7 * 24h; age += 1h) ASSERT_TRUE(sessions.touch(session.number, kStart + age));
  EXPECT_FALSE(sessions.touch(session.number, kStart + 7 * 24h));
}

TEST_F(SessionsTest, AreAtMost64AndTheLongestIdleGoes) {
  std::vector<Session> all;
  for (int i = 0; i < 64; ++i) all.push_back(begin(Role::Viewer, kStart + i * 1s));
  EXPECT_TRUE(lives(all[0], kStart + 100s));
  const Session one_more = begin(Role::Viewer, kStart + 101s);
  EXPECT_EQ(sessions.all(kStart + 101s).size(), 64u);
  EXPECT_TRUE(lives(one_more, kStart + 101s));
  EXPECT_TRUE(lives(all[0], kStart + 101s)) << "the session was used since";
  EXPECT_FALSE(lives(all[1], kStart + 101s));
}

TEST_F(SessionsTest, EndOneByOneOrByRole) {
  const Session viewer = begin(Role::Viewer, kStart), mine = begin(Role::Operator, kStart),
                other = begin(Role::Operator, kStart);
  sessions.end_all(Role::Operator, mine.number);
  EXPECT_TRUE(lives(viewer, kStart));
  EXPECT_TRUE(lives(mine, kStart));
  EXPECT_FALSE(lives(other, kStart));
  EXPECT_TRUE(sessions.end(viewer.number));
  EXPECT_FALSE(sessions.end(viewer.number));
  EXPECT_FALSE(lives(viewer, kStart));
}

TEST_F(SessionsTest, KeepTheBrowsersNameAsShortPlainText) {
  EXPECT_EQ(begin(Role::Viewer, kStart, "a\x1b[2Jb\xc3\xa9\n").agent, "a?[2Jb???");
  EXPECT_EQ(begin(Role::Viewer, kStart, std::string(300, 'x')).agent,
            std::string(Sessions::kLongestAgent, 'x'));
}

/// Invariants over many random steps.
TEST_F(SessionsTest, HaveUniqueIdsAndEndInTime) {
  std::set<std::string> ids;
  std::set<std::uint64_t> numbers;
  std::vector<Session> known;
  Instant now = kStart;
  for (int step = 0; step < 3000; ++step) {
    now += std::chrono::minutes(random() % 40);
    if (random() % 3 == 0) {
      const Session session = begin(random() % 2 ? Role::Viewer : Role::Operator, now);
      EXPECT_TRUE(ids.insert(session.id.reveal()).second);
      EXPECT_TRUE(ids.insert(session.csrf.reveal()).second);
      EXPECT_TRUE(numbers.insert(session.number).second);
      known.push_back(session);
    } else if (!known.empty()) {
      (void)sessions.find(known[random() % known.size()].id.reveal(), now);
    }
    const auto all = sessions.all(now);
    ASSERT_LE(all.size(), Sessions::kMost);
    for (const Session& each : all) {
      ASSERT_LT(now - each.seen, Sessions::kIdle);
      ASSERT_LT(now - each.made, Sessions::kLongest);
    }
  }
  EXPECT_GT(known.size(), 900u);
}

TEST_F(SessionsTest, OfViewersDisplaceNoOperator) {
  const Session mine = begin(Role::Operator, kStart);
  for (std::size_t i = 0; i < 2 * Sessions::kMost; ++i) begin(Role::Viewer, kStart + 1h);
  EXPECT_TRUE(lives(mine, kStart + 2h));
  EXPECT_EQ(sessions.all(kStart + 2h).size(), Sessions::kMost);
}

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
    return write_sessions({.boot = "boot-1", .last = sessions.last(), .sessions = sessions.entries()});
  }
  /// The sessions in the file, read after a restart at `now`.
  Sessions restored(Instant now) const {
    auto kept = read_sessions(written()).value();
    Sessions after;
    after.restore(std::move(kept.sessions), kept.last, now);
    return after;
  }

  std::mt19937 random{3};
  Sessions sessions;
};

TEST_F(SessionFileTest, HoldsAllMembersOfASession) {
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

TEST_F(SessionFileTest, ExtendsNoSession) {
  const Session mine = begin(sessions, Role::Operator, kStart);
  Sessions early = restored(kStart + 12h - 1s), late = restored(kStart + 12h);
  EXPECT_NE(early.find(mine.id.reveal(), kStart + 12h - 1s), nullptr);
  EXPECT_EQ(late.find(mine.id.reveal(), kStart + 12h), nullptr);
}

TEST_F(SessionFileTest, FromAnotherBootIsDropped) {
  const Session mine = begin(sessions, Role::Operator, kStart);
  Sessions after = restored(kStart - 1s);
  EXPECT_EQ(after.find(mine.id.reveal(), kStart - 1s), nullptr);
}

TEST_F(SessionFileTest, KeepsNumbersUnique) {
  begin(sessions, Role::Operator, kStart);
  const Session second = begin(sessions, Role::Operator, kStart);
  sessions.end(second.number);
  Sessions after = restored(kStart);
  EXPECT_GT(begin(after, Role::Operator, kStart).number, second.number);
}

TEST_F(SessionFileTest, IsWrittenAtEachLoginAndLogout) {
  int told = 0;
  Sessions watched([&told] { ++told; });
  const Session mine = begin(watched, Role::Operator, kStart);
  EXPECT_EQ(told, 1);
  (void)watched.find(mine.id.reveal(), kStart);
  EXPECT_EQ(told, 1) << "a read access causes no write";
  EXPECT_FALSE(watched.end(99));
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(watched.end(mine.number));
  EXPECT_EQ(told, 2);
  watched.end_all(Role::Operator, 0);
  EXPECT_EQ(told, 3);
}

TEST_F(SessionFileTest, IfDamagedTellsWhyButShowsNoSecret) {
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
