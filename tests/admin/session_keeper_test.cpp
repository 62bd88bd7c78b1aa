#include <gtest/gtest.h>

#include <filesystem>

#include "admin/kept_file.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::admin {
namespace {

using namespace std::chrono_literals;

constexpr access::Instant kStart{100h};

class SessionKeeperTest : public testing::Test {
 protected:
  std::string log_in(SessionKeeper& keeper) {
    const access::Secret id{++drawn_}, csrf{++drawn_};
    return keeper.sessions()
        .begin(id, csrf, access::Role::Operator, {"10.0.0.5", "browser"}, kStart)
        .id.reveal();
  }
  bool knows(SessionKeeper& keeper, const std::string& id) {
    return keeper.sessions().find(id, kStart) != nullptr;
  }

  host::Folder folder_;
  const std::string file_ = folder_ / "sessions.json";
  std::uint8_t drawn_ = 0;
};

TEST_F(SessionKeeperTest, StoresSessionsAtOnce) {
  SessionKeeper before(file_, kStart);
  const std::string mine = log_in(before), other = log_in(before);
  before.sessions().end(before.sessions().all(kStart).front().number);
  SessionKeeper after(file_, kStart);
  EXPECT_TRUE(knows(after, mine));
  EXPECT_FALSE(knows(after, other)) << "a logged-out session came back";
  struct stat status{};
  ASSERT_EQ(stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0600u);
}

TEST_F(SessionKeeperTest, ForgetsSessionsOfAnotherBoot) {
  SessionKeeper before(file_, kStart);
  const std::string mine = log_in(before);
  std::string text = host::read_file(file_).value();
  const std::string boot = "\"boot\":\"" + host::boot();
  text.replace(text.find(boot), boot.size(), "\"boot\":\"another");
  folder_.put("sessions.json", text);
  SessionKeeper after(file_, kStart);
  EXPECT_FALSE(knows(after, mine));
}

TEST_F(SessionKeeperTest, StartsEmptyIfTheFileIsDamaged) {
  folder_.put("sessions.json", "{\"version\":1,");
  SessionKeeper keeper(file_, kStart);
  EXPECT_TRUE(keeper.sessions().all(kStart).empty());
  const std::string mine = log_in(keeper);
  SessionKeeper after(file_, kStart);
  EXPECT_TRUE(knows(after, mine));
}

TEST_F(SessionKeeperTest, WorksInMemoryIfTheFileIsUnusable) {
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  for (const std::string& file : {folder_ / "none/sessions.json", file_}) {
    SessionKeeper keeper(file, kStart);
    const std::string mine = log_in(keeper);
    EXPECT_TRUE(knows(keeper, mine));
  }
  EXPECT_TRUE(std::filesystem::is_fifo(file_)) << "an unreadable file stays as it is";
}

}  // namespace
}  // namespace adit::admin
