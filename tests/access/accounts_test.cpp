#include "access/accounts.hpp"

#include <gmock/gmock.h>

#include "access/password.hpp"

namespace adit::access {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Accounts, ReadBackTheSame) {
  for (const Accounts& accounts : {Accounts{}, Accounts{.viewer = {}, .operator_ = "$y$j9T$a$b"},
                                   Accounts{.viewer = "$y$j9T$c$d", .operator_ = "$y$j9T$a$b"}}) {
    EXPECT_EQ(read_accounts(write_accounts(accounts)), accounts);
  }
  EXPECT_EQ(write_accounts({.viewer = {}, .operator_ = "$y$x"}),
            "{\"version\":1,\"operator\":\"$y$x\",\"viewer\":null}\n");
}

TEST(Accounts, AreRejectedIfDamaged) {
  for (const char* text :
       {"", "null", "[]", "{}", "{\"version\":2,\"operator\":\"$y$x\"}", "{\"version\":1,\"operator\":7}",
        "{\"version\":1,\"operator\":\"a secret\"}", "{\"version\":1,\"operator\":\"$y$x\",\"oper"}) {
    const auto read = read_accounts(text);
    ASSERT_FALSE(read) << text;
    EXPECT_THAT(read.error(), Not(HasSubstr("secret")));
  }
}

TEST(Accounts, FindTheRoleOfAPassword) {
  const Accounts accounts{.viewer = hash("look, do not touch", {1}).value(),
                          .operator_ = hash("correct horse", {2}).value()};
  EXPECT_EQ(role_of("correct horse", accounts), Role::Operator);
  EXPECT_EQ(role_of("look, do not touch", accounts), Role::Viewer);
  EXPECT_EQ(role_of("another", accounts), std::nullopt);
  EXPECT_EQ(role_of("", Accounts{}), std::nullopt);
}

TEST(Roles, HaveNames) {
  for (const Role role : {Role::Viewer, Role::Operator}) EXPECT_EQ(role_named(name_of(role)), role);
  EXPECT_EQ(role_named("root"), std::nullopt);
}

}  // namespace
}  // namespace adit::access
