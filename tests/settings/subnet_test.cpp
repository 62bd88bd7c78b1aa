#include "settings/subnet.hpp"

#include <gtest/gtest.h>

namespace adit::settings {
namespace {

Subnet subnet(std::string_view text) {
  const auto parsed = parse_subnet(text);
  EXPECT_TRUE(parsed) << text;
  return parsed.value_or(Subnet{});
}

TEST(Subnet, IsReadAndWritten) {
  EXPECT_EQ(subnet("10.1.1.0/24"), (Subnet{0x0a010100, 24}));
  EXPECT_EQ(to_text(subnet("192.168.7.11/24")), "192.168.7.0/24");
  EXPECT_EQ(to_text(subnet("255.255.255.255/32")), "255.255.255.255/32");
  EXPECT_EQ(to_text(subnet("10.0.0.1/0")), "0.0.0.0/0");
}

TEST(Subnet, RejectsOtherForms) {
  for (const char* text : {"",
                           "/",
                           "10.1.1.0",
                           "10.1.1.0/",
                           "10.1.1.0/33",
                           "10.1.1.0/-1",
                           "10.1.1.0/+8",
                           "10.1.1/24",
                           "10.1.1.0.0/24",
                           "10.1.1.256/24",
                           "010.1.1.0/24",
                           "10.1.1.0/024",
                           " 10.1.1.0/24",
                           "10.1.1.0/24 ",
                           "10..1.0/24",
                           "a.b.c.d/24",
                           "fd00::1/64",
                           "10.1.1.0/24/24",
                           "99999999999.1.1.1/8",
                           ".10.1.1.0/24",
                           "10.1.1.0./24"}) {
    EXPECT_FALSE(parse_subnet(text)) << text;
  }
  EXPECT_FALSE(ipv4_of("10.1.1.1."));
  EXPECT_FALSE(ipv4_of(std::string_view("10.1.1.1\0", 9)));
}

TEST(Subnet, KnowsItsEnds) {
  const Subnet host = subnet("192.168.7.77/26");
  EXPECT_EQ(ipv4_text(host.first()), "192.168.7.64");
  EXPECT_EQ(ipv4_text(host.last()), "192.168.7.127");
  EXPECT_TRUE(host.contains(*ipv4_of("192.168.7.127")));
  EXPECT_FALSE(host.contains(*ipv4_of("192.168.7.128")));
}

TEST(Subnets, OverlapIfOneContainsTheOther) {
  const struct {
    const char *a, *b;
    bool overlap;
  } cases[] = {{"10.100.0.0/16", "10.100.7.0/24", true},  {"10.100.7.9/24", "10.100.7.200/25", true},
               {"10.100.0.0/16", "10.101.0.0/16", false}, {"10.0.0.0/8", "10.2.1.0/24", true},
               {"10.1.1.0/24", "10.1.2.0/24", false},     {"0.0.0.0/0", "203.0.113.7/32", true},
               {"10.1.1.1/32", "10.1.1.1/32", true},      {"10.1.1.1/32", "10.1.1.2/32", false}};
  for (const auto& [a, b, overlap] : cases) {
    EXPECT_EQ(overlaps(subnet(a), subnet(b)), overlap) << a << ' ' << b;
    EXPECT_EQ(overlaps(subnet(b), subnet(a)), overlap) << b << ' ' << a;
  }
}

TEST(Subnets, OfTheCommandPostAreKnown) {
  std::string all;
  for (const Subnet& each : command_post_subnets()) all += to_text(each) + ' ';
  EXPECT_EQ(all, "10.1.1.0/24 10.2.1.0/24 10.100.0.0/16 ");
}

}  // namespace
}  // namespace adit::settings
