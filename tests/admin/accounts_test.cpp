#include "admin/accounts.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <future>

#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::admin {
namespace {

using namespace std::chrono_literals;
using access::Role;

constexpr const char* kOld = "correct horse battery";
constexpr const char* kNew = "another horse entirely";

/// aditd's part that knows passwords, from start to end.
struct Life {
  explicit Life(const host::Folder& folder, const char* label_code = "12345678")
      : sessions(folder / "sessions.json", loop.now()),
        accounts(loop, workers, writer, sessions, folder.path(), icd::BearerToken::parse(label_code)) {}

  /// Why it was refused, or "".
  std::string set(Role role, const std::string& password) {
    std::optional<std::string> why;
    accounts.set(role, password,
                 [&why](const icd::Checked<void>& kept) { why = kept ? "" : kept.error().sentence; });
    while (!why) loop.turn(100ms);
    return *why;
  }
  std::string add_device(Role role) { return accounts.devices().add(accounts.draw(), role).id.reveal(); }
  bool knows(const std::string& id) { return accounts.devices().find(id) != nullptr; }

  loop::Loop loop;
  loop::Workers workers{loop, 1};
  loop::Writer writer{loop};
  SessionKeeper sessions;
  Accounts accounts;
};

TEST(Accounts, OldPasswordsDevicesAreForgottenAfterAKill) {
  const host::Folder folder;
  std::string old_operators, viewers;
  {
    Life life(folder);
    life.set(Role::Operator, kOld);
    life.set(Role::Viewer, "look, do not touch");
    old_operators = life.add_device(Role::Operator);
    viewers = life.add_device(Role::Viewer);
  }
  const std::string before = host::read_file(folder / Accounts::kDevicesFile).value();
  {
    Life life(folder);
    ASSERT_TRUE(life.knows(old_operators));
    life.set(Role::Operator, kNew);
    life.accounts.devices().end_all(Role::Operator, 0);
  }
  folder.put(Accounts::kDevicesFile, before);  // killed before the writer came to it
  Life life(folder);
  EXPECT_FALSE(life.knows(old_operators));
  EXPECT_TRUE(life.knows(viewers));
}

TEST(Accounts, CodeIsStoredOnlyWhileRequired) {
  const host::Folder folder;
  Life(folder).set(Role::Operator, kOld);
  const std::string code =
      folder.put(Accounts::kCodeFile, "87654321\n");  // a kill came first, or a card brought it
  const Life life(folder);
  EXPECT_FALSE(std::filesystem::exists(code));
}

TEST(Accounts, UnreadableFileSetsNoPasswordAndIsKept) {
  for (const char* const name : {Accounts::kFile, Accounts::kCodeFile}) {
    const host::Folder folder;
    ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
    Life life(folder, name == Accounts::kFile ? "12345678" : "");
    EXPECT_FALSE(life.accounts.first_start() || life.accounts.code()) << name;
    life.accounts.open_set_up();
    EXPECT_EQ(life.set(Role::Operator, kNew),
              "the passwords cannot be read: " + (folder / name) + ": is not a regular file");
    EXPECT_TRUE(std::filesystem::is_fifo(folder / name));
  }
}

TEST(Accounts, DamagedFileIsRenamedAndTheCodeIsRequired) {
  const host::Folder folder;
  Life(folder).set(Role::Operator, kOld);
  folder.put(Accounts::kFile, "{\"version\":1,\"oper");
  const Life life(folder);
  EXPECT_TRUE(life.accounts.is_code("12345678"));
  EXPECT_TRUE(std::filesystem::exists(folder / "access.json.damaged"));
}

TEST(Accounts, UnreadableDevicesFileIsKept) {
  const host::Folder folder;
  ASSERT_EQ(mkfifo((folder / Accounts::kDevicesFile).c_str(), 0600), 0);
  {
    Life life(folder);
    life.set(Role::Operator, kOld);
    EXPECT_TRUE(life.knows(life.add_device(Role::Operator)));
  }
  EXPECT_TRUE(std::filesystem::is_fifo(folder / Accounts::kDevicesFile));
}

TEST(Accounts, DeviceThatSetThePasswordStaysKnown) {
  const host::Folder folder;
  std::string own;
  {
    Life life(folder);
    life.set(Role::Operator, kOld);
    own = life.add_device(Role::Operator);
    life.set(Role::Operator, kNew);
    life.accounts.devices().end_all(Role::Operator, life.accounts.devices().find(own)->number);
  }
  Life life(folder);
  EXPECT_TRUE(life.knows(own));
}

TEST(Accounts, PasswordChangedDuringACheckIsRejected) {
  const host::Folder folder;
  Life life(folder);
  life.set(Role::Operator, kOld);
  bool is_set = false;
  std::optional<std::optional<Role>> found;
  life.accounts.set(Role::Operator, kNew, [&](const icd::Checked<void>&) { is_set = true; });
  std::promise<void> held;
  auto until = std::make_shared<std::shared_future<void>>(held.get_future());
  life.workers.submit(loop::Urgency::OnTheWay, [until] { until->wait(); }, [] {});
  life.accounts.check(kOld, "10.0.0.5", [&](std::optional<Role> role) { found = role; });
  while (!is_set) life.loop.turn(100ms);
  held.set_value();
  while (!found) life.loop.turn(100ms);
  EXPECT_EQ(*found, std::nullopt);
}

}  // namespace
}  // namespace adit::admin
