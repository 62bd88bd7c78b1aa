#include <gmock/gmock.h>

#include "access/accounts.hpp"

namespace adit::access {
namespace {

using testing::HasSubstr;

const Accounts kAccounts{.viewer = "$y$j9T$view$a-hash", .operator_ = "$y$j9T$oper$a-hash"};

Secret secret(std::uint8_t first) {
  return {first};
}

std::string id(std::uint8_t first) {
  return to_token(secret(first)).reveal();
}

TEST(Devices, AreKnownByTheirIds) {
  Devices devices;
  EXPECT_EQ(devices.find(id(1)), nullptr);
  const auto number = devices.add(secret(1), Role::Operator).number;
  devices.add(secret(2), Role::Viewer);
  ASSERT_NE(devices.find(id(1)), nullptr);
  EXPECT_EQ(devices.find(id(1))->number, number);
  EXPECT_EQ(devices.find(id(2))->role, Role::Viewer);
  EXPECT_EQ(devices.find(""), nullptr);
  EXPECT_EQ(devices.find(id(3)), nullptr);
}

TEST(Devices, AreLimitedPerRoleAndTheLongestUnseenGoes) {
  Devices devices;
  devices.add(secret(200), Role::Operator);
  for (std::uint8_t i = 0; i < Devices::kMostOfRole; ++i) devices.add(secret(i), Role::Viewer);
  EXPECT_NE(devices.find(id(0)), nullptr);  // seen now
  devices.add(secret(100), Role::Viewer);
  EXPECT_NE(devices.find(id(0)), nullptr);
  EXPECT_EQ(devices.find(id(1)), nullptr);
  EXPECT_NE(devices.find(id(200)), nullptr) << "viewers must not displace operators";
}

TEST(Devices, EndWithThePasswordOfTheirRole) {
  int changes = 0;
  Devices devices({}, [&] { ++changes; });
  const auto own = devices.add(secret(1), Role::Operator).number;
  devices.add(secret(2), Role::Operator);
  devices.add(secret(3), Role::Viewer);
  EXPECT_EQ(changes, 3);
  devices.end_all(Role::Operator, own);
  EXPECT_EQ(changes, 4);
  EXPECT_NE(devices.find(id(1)), nullptr);
  EXPECT_EQ(devices.find(id(2)), nullptr);
  EXPECT_NE(devices.find(id(3)), nullptr);
  devices.end_all(Role::Operator, own);
  EXPECT_EQ(changes, 5) << "the own device has the new password";
  devices.end_all(Role::Operator, 0);
  devices.end_all(Role::Operator, 0);
  EXPECT_EQ(changes, 6) << "no device to store";
}

TEST(Devices, ReadBackTheSame) {
  Devices devices;
  devices.add(secret(1), Role::Operator);
  devices.add(secret(2), Role::Viewer);
  auto kept = read_devices(write_devices(devices.all(), kAccounts), kAccounts);
  ASSERT_TRUE(kept) << kept.error();
  Devices again(std::move(*kept));
  ASSERT_EQ(again.all().size(), 2u);
  EXPECT_EQ(again.all()[0].role, Role::Operator);
  EXPECT_NE(again.all()[0].number, again.all()[1].number);
  EXPECT_NE(again.find(id(1)), nullptr);
}

TEST(Devices, OfAnOldPasswordAreForgotten) {
  Devices devices;
  devices.add(secret(1), Role::Operator);
  devices.add(secret(2), Role::Viewer);
  const std::string written = write_devices(devices.all(), kAccounts);
  EXPECT_EQ(written.find("a-hash"), std::string::npos);
  const auto known_to = [&written](const Accounts& accounts) {
    std::vector<Role> roles;
    const auto kept = read_devices(written, accounts).value();
    for (const Device& device : kept) roles.push_back(device.role);
    return roles;
  };
  EXPECT_EQ(known_to({.viewer = kAccounts.viewer, .operator_ = "$y$j9T$else$a-hash"}),
            std::vector{Role::Viewer});
  EXPECT_EQ(known_to({.viewer = {}, .operator_ = kAccounts.operator_}), std::vector{Role::Operator});
  EXPECT_EQ(known_to({}), std::vector<Role>());
}

TEST(Devices, OfADamagedFileAreRejectedButNotShown) {
  const std::string whole =
      write_devices({{.number = 1, .role = Role::Operator, .id = to_token(secret(7))}}, kAccounts);
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string(R"({"version":1,"devices":[]})"),
        std::string(R"({"version":2,"devices":[{"role":"boss","id":"aaaaaaaaaaaaaaaa"}]})"),
        std::string(R"({"version":2,"devices":[{"role":"viewer"}]})"), whole.substr(0, whole.size() / 2)}) {
    const auto read = read_devices(text, kAccounts);
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error(), testing::Not(HasSubstr(id(7))));
  }
}

}  // namespace
}  // namespace adit::access
