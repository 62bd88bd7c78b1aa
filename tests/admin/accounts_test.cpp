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

/// The parts of aditd that know passwords, from start to end of a process.
struct AditdProcess {
  explicit AditdProcess(const host::Folder& folder, const char* label_code = "12345678")
      : sessions(folder / "sessions.json", loop.now()),
        accounts(loop, workers, writer, sessions, folder.path(), icd::BearerToken::parse(label_code)) {}

  /// Returns the error, or "".
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
    AditdProcess process(folder);
    process.set(Role::Operator, kOld);
    process.set(Role::Viewer, "look, do not touch");
    old_operators = process.add_device(Role::Operator);
    viewers = process.add_device(Role::Viewer);
  }
  const std::string before = host::read_file(folder / Accounts::kDevicesFile).value();
  {
    AditdProcess process(folder);
    ASSERT_TRUE(process.knows(old_operators));
    process.set(Role::Operator, kNew);
    process.accounts.devices().end_all(Role::Operator, 0);
  }
  folder.put(Accounts::kDevicesFile, before);  // killed before the writer wrote
  AditdProcess process(folder);
  EXPECT_FALSE(process.knows(old_operators));
  EXPECT_TRUE(process.knows(viewers));
}

TEST(Accounts, CodeIsStoredOnlyWhileRequired) {
  const host::Folder folder;
  AditdProcess(folder).set(Role::Operator, kOld);
  const std::string code =
      folder.put(Accounts::kCodeFile, "87654321\n");  // left by a kill or copied to the card
  const AditdProcess process(folder);
  EXPECT_FALSE(std::filesystem::exists(code));
}

TEST(Accounts, UnreadableFileSetsNoPasswordAndIsKept) {
  for (const char* const name : {Accounts::kFile, Accounts::kCodeFile}) {
    const host::Folder folder;
    ASSERT_EQ(mkfifo((folder / name).c_str(), 0600), 0);
    AditdProcess process(folder, name == Accounts::kFile ? "12345678" : "");
    EXPECT_FALSE(process.accounts.first_start() || process.accounts.code()) << name;
    process.accounts.open_set_up();
    EXPECT_EQ(process.set(Role::Operator, kNew),
              "the passwords cannot be read: " + (folder / name) + ": is not a regular file");
    EXPECT_TRUE(std::filesystem::is_fifo(folder / name));
  }
}

TEST(Accounts, DamagedFileIsRenamedAndTheCodeIsRequired) {
  const host::Folder folder;
  AditdProcess(folder).set(Role::Operator, kOld);
  folder.put(Accounts::kFile, "{\"version\":1,\"oper");
  EXPECT_FALSE(AditdProcess(folder).accounts.first_start()) << "it has a copy";
  folder.put(std::string(Accounts::kFile) + host::kCopy, "");
  const AditdProcess process(folder);
  EXPECT_TRUE(process.accounts.is_code("12345678"));
  EXPECT_TRUE(std::filesystem::exists(folder / "access.json.damaged"));
}

TEST(Accounts, UnreadableDevicesFileIsKept) {
  const host::Folder folder;
  ASSERT_EQ(mkfifo((folder / Accounts::kDevicesFile).c_str(), 0600), 0);
  {
    AditdProcess process(folder);
    process.set(Role::Operator, kOld);
    EXPECT_TRUE(process.knows(process.add_device(Role::Operator)));
  }
  EXPECT_TRUE(std::filesystem::is_fifo(folder / Accounts::kDevicesFile));
}

TEST(Accounts, DeviceThatSetThePasswordStaysKnown) {
  const host::Folder folder;
  std::string own;
  {
    AditdProcess process(folder);
    process.set(Role::Operator, kOld);
    own = process.add_device(Role::Operator);
    process.set(Role::Operator, kNew);
    process.accounts.devices().end_all(Role::Operator, process.accounts.devices().find(own)->number);
  }
  AditdProcess process(folder);
  EXPECT_TRUE(process.knows(own));
}

TEST(Accounts, PasswordChangedDuringACheckIsRejected) {
  const host::Folder folder;
  AditdProcess process(folder);
  process.set(Role::Operator, kOld);
  bool is_set = false;
  std::optional<std::optional<Role>> found;
  process.accounts.set(Role::Operator, kNew, [&](const icd::Checked<void>&) { is_set = true; });
  std::promise<void> held;
  auto until = std::make_shared<std::shared_future<void>>(held.get_future());
  process.workers.submit(loop::Urgency::OnTheWay, [until] { until->wait(); }, [] {});
  process.accounts.check(kOld, "10.0.0.5", [&](std::optional<Role> role) { found = role; });
  while (!is_set) process.loop.turn(100ms);
  held.set_value();
  while (!found) process.loop.turn(100ms);
  EXPECT_EQ(*found, std::nullopt);
}

}  // namespace
}  // namespace adit::admin
