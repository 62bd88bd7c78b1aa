#include "applier/team_ports.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "host/folder.hpp"
#include "host/service.hpp"
#include "network/messages.hpp"

namespace adit::applier {
namespace {

class PortRulesTest : public testing::Test {
 protected:
  PortRulesTest() {
    options_.wanted = asked_.path();
    options_.status = run_.path();
  }
  bool is_done() {
    const bool done = write_port_rules(options_).has_value();
    return done && std::filesystem::is_empty(asked_.path());
  }
  std::string rules() const { return host::read_file(run_ / network::kPortRulesFile).value_or("none"); }

  host::Folder asked_, run_;
  Options options_;
};

TEST_F(PortRulesTest, FollowTheRequest) {
  EXPECT_TRUE(is_done());
  EXPECT_EQ(rules(), "none") << "no request";
  const network::TeamPorts ports{{80, 9000}};
  asked_.put(network::kPortsFile, codec::write_file(ports));
  EXPECT_TRUE(is_done());
  EXPECT_EQ(rules(), network::rules_for(ports));
  EXPECT_TRUE(is_done());
  EXPECT_EQ(rules(), network::rules_for(ports));
}

TEST_F(PortRulesTest, MalformedRequestChangesNothing) {
  for (const char* const text : {"", "[80]", R"({"format":1,"ports":["80 } ; flush ruleset"]})"}) {
    asked_.put(network::kPortsFile, text);
    EXPECT_TRUE(is_done()) << text;
    EXPECT_EQ(rules(), "none") << text;
  }
  const std::string secret = run_ / "secret";
  ASSERT_TRUE(host::write_file(secret, codec::write_file(network::TeamPorts{{22}}), host::kOursAlone));
  std::filesystem::create_symlink(secret, asked_ / network::kPortsFile);
  EXPECT_TRUE(is_done());
  EXPECT_EQ(rules(), "none") << "a link is not followed";
}

}  // namespace
}  // namespace adit::applier
