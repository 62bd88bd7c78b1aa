#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/ask.hpp"

namespace adit::cli {
namespace {

using settings::Address;
using testing::HasSubstr;

settings::Team team(const Address& address, const std::string& interface) {
  settings::Team team;
  team.listen = {address};
  team.interface = interface;
  return team;
}

TEST(ParseAddress, AcceptsBothFamilies) {
  EXPECT_EQ(parse_address("10.0.0.1:8000").value(), (Address{"10.0.0.1", 8000}));
  EXPECT_EQ(parse_address("[fd00::1]:65535").value(), (Address{"fd00::1", 65535}));
  EXPECT_EQ(parse_address("10.0.0.1").value(), (Address{"10.0.0.1", 8000}));
  EXPECT_EQ(parse_address("[fd00::1]").value(), (Address{"fd00::1", 8000}));
}

TEST(ParseAddress, RejectsInvalidAddresses) {
  for (const std::string text :
       {"", ":", "8000", "[", "]", "[]", "10.0.0.1:", "10.0.0.1:0", "10.0.0.1:65536", "10.0.0.1:+1",
        "10.0.0:80", "host:80", "fd00::1:80", "[10.0.0.1]:80", "[10.0.0.1]", "fd00::1", "10.0.0.1:80 "}) {
    const auto address = parse_address(text);
    ASSERT_FALSE(address.has_value()) << text;
    EXPECT_THAT(address.error(), HasSubstr("got '" + text + "'"));
  }
}

TEST(ParseLocation, AcceptsNamesAndUrls) {
  const std::pair<const char*, Address> kPlaces[] = {
      {"10.0.0.1", {"10.0.0.1", 8000}},
      {"adit.local", {"adit.local", 8000}},
      {"localhost:8080", {"localhost", 8080}},
      {"http://127.0.0.1:8000", {"127.0.0.1", 8000}},
      {"http://127.0.0.1:8000/setup#tokens", {"127.0.0.1", 8000}},
      {"http://adit.local/", {"adit.local", 80}},
      {"http://10.0.0.1", {"10.0.0.1", 80}},
      {"http://[fd00::1]/", {"fd00::1", 80}},
      {"http://[fd00::1]:8000/", {"fd00::1", 8000}},
  };
  for (const auto& [text, address] : kPlaces) {
    const auto found = parse_location(text);
    ASSERT_TRUE(found.has_value()) << text << ": " << found.error();
    EXPECT_EQ(*found, address) << text;
  }
}

TEST(ParseLocation, RejectsOthers) {
  for (const std::string text : {"", "adit.local:", "adit.local:0", "adit local", "http://",
                                 "ftp://adit.local", "10.0.0", "adit.local/setup", "fd00::1"}) {
    const auto address = parse_location(text);
    ASSERT_FALSE(address.has_value()) << text;
    EXPECT_THAT(address.error(), HasSubstr("got '" + text + "'"));
  }
  EXPECT_THAT(parse_location("https://adit.local").error(), HasSubstr("http:// instead of https://"));
}

TEST(ParseAddress, ReadsBackTheSame) {
  for (const Address& address : {Address{"10.0.0.1", 1}, Address{"fd00::1", 8000}}) {
    EXPECT_EQ(parse_address(to_text(address)).value(), address);
  }
}

TEST(AditAddress, IsTheListeningAddress) {
  EXPECT_EQ(reach(team({"10.0.0.1", 8000}, "team0")).value(), (Address{"10.0.0.1", 8000}));
}

TEST(AditAddress, IsLoopbackIfAditListensEverywhere) {
  EXPECT_EQ(reach(team({"0.0.0.0", 8000}, "")).value(), (Address{"127.0.0.1", 8000}));
  EXPECT_EQ(reach(team({"::", 8000}, "")).value(), (Address{"::1", 8000}));
  EXPECT_EQ(reach(team({"0:0::0", 8000}, "")).value(), (Address{"::1", 8000}));
}

TEST(AditAddress, IsAnAddressOfTheBoundInterface) {
  EXPECT_EQ(reach(team({"0.0.0.0", 8000}, "lo")).value(), (Address{"127.0.0.1", 8000}));
  EXPECT_EQ(reach(team({"0.0.0.0", 8000}, "nosuch0")).error(),
            "interface nosuch0 (team.interface) has no address");
}

TEST(AditAddress, IsUnknownForAnyFreePort) {
  EXPECT_THAT(reach(team({"0.0.0.0", 0}, "")).error(), HasSubstr("--at ADDR:PORT"));
}

}  // namespace
}  // namespace adit::cli
