#include "admin/factory_reset.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "host/folder.hpp"

namespace adit::admin {
namespace {

using testing::HasSubstr;

class FactoryResetTest : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* file : {"access.json", "access.json.damaged", "acknowledged.json", "devices.json",
                             "first-start.code", "settings.json", "tls.pem", "tls.pem.damaged", "ledger"})
      state_.put(file, "something");
    std::filesystem::create_directory(state_ / "secrets");
    state_.put("secrets/team.token", "secret");
    runtime_.put("sessions.json", "who is logged in");
    for (const char* folder : {"journal", "waiting", "rejected"}) {
      std::filesystem::create_directory(runtime_ / folder);
      runtime_.put(std::string(folder) + "/1", "a message of the team before");
    }
  }
  bool kept(const char* name) const { return std::filesystem::exists(state_ / name); }
  void expect_first_start() const {
    for (const char* gone :
         {"access.json", "access.json.damaged", "acknowledged.json", "devices.json", "first-start.code",
          "settings.json", "tls.pem", "tls.pem.damaged", "secrets", "reset"})
      EXPECT_FALSE(kept(gone)) << gone;
    EXPECT_FALSE(std::filesystem::exists(runtime_ / "sessions.json"));
    for (const char* gone : {"journal", "waiting", "rejected"}) {
      EXPECT_FALSE(std::filesystem::exists(runtime_ / gone))
          << "a leftover message would be sent by the next team";
    }
    EXPECT_TRUE(kept("forget.json")) << "no request to adit-network to forget the addresses";
    EXPECT_TRUE(kept("ledger"));
  }

  host::Folder state_, runtime_, given_;
  Store store_{given_ / "settings.json", given_.path(), state_.path()};
  FactoryReset reset_{store_, state_.path(), runtime_.path()};
};

TEST_F(FactoryResetTest, DeletesNothingUnlessBegun) {
  EXPECT_EQ(reset_.finish(), false);
  EXPECT_TRUE(kept("access.json") && kept("settings.json") && kept("secrets/team.token"));
  EXPECT_FALSE(kept("forget.json"));
}

TEST_F(FactoryResetTest, DeletesAllButTheReportsOnce) {
  ASSERT_TRUE(reset_.begin());
  EXPECT_TRUE(kept("access.json")) << "a file in use was removed";
  EXPECT_EQ(reset_.finish(), true);
  expect_first_start();
  state_.put("access.json", "a new password");
  EXPECT_EQ(reset_.finish(), false);
  EXPECT_TRUE(kept("access.json"));
}

TEST_F(FactoryResetTest, ContinuesAfterAnInterruption) {
  std::filesystem::remove(state_ / "access.json");
  std::filesystem::create_directory(state_ / "access.json");  // a file that cannot be removed
  ASSERT_TRUE(reset_.begin());
  const auto done = reset_.finish();
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error(), HasSubstr("access.json: cannot be removed"));
  EXPECT_FALSE(kept("secrets"));
  std::filesystem::remove(state_ / "access.json");
  FactoryReset at_the_next_start(store_, state_.path(), runtime_.path());
  ASSERT_TRUE(at_the_next_start.finish());
  expect_first_start();
}

TEST_F(FactoryResetTest, DeletesNothingIfItsRequestCannotBeRead) {
  FactoryReset unknown(store_, state_ / std::string(300, 'x'), runtime_.path());
  EXPECT_THAT(unknown.finish().error(), HasSubstr("/reset: File name too long"));
  EXPECT_TRUE(kept("settings.json") && kept("secrets/team.token"));
  EXPECT_TRUE(std::filesystem::exists(runtime_ / "sessions.json"));
}

TEST_F(FactoryResetTest, IsRejectedIfItCannotBeRecorded) {
  FactoryReset nowhere(store_, state_ / "none", runtime_.path());
  EXPECT_THAT(nowhere.begin().error(), HasSubstr("No such file or directory"));
  ASSERT_TRUE(reset_.finish());
  EXPECT_TRUE(kept("access.json"));
}

}  // namespace
}  // namespace adit::admin
