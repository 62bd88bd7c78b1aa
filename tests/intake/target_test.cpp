#include <gtest/gtest.h>

#include "intake/head.hpp"

namespace adit::intake {
namespace {

struct Case {
  std::string_view raw, path;
};

TEST(Target, IsDecodedOnce) {
  const Case cases[] = {
      {"/map/update", "/map/update"},
      {"/map/update/", "/map/update/"},
      {"/map/update?x=1", "/map/update"},
      {"/map/update?", "/map/update"},
      {"/%6Dap/update", "/map/update"},
      {"/a%2525", "/a%25"},
      {"/a+b", "/a+b"},
      {"/%c3%a9", "/\xc3\xa9"},
      {"http://10.0.0.1:8000/api/status", "/api/status"},
      {"http://10.0.0.1:8000", "/"},
      {"/a#b", "/a"},
      {"*", "*"},
      {"/../../etc/passwd", "/../../etc/passwd"},
  };
  for (const Case& c : cases) {
    const auto target = parse_target(c.raw);
    ASSERT_TRUE(target) << c.raw;
    EXPECT_EQ(target->path, c.path) << c.raw;
  }
}

TEST(Target, IsRejectedIfItIsNoPathOfText) {
  for (const std::string_view raw :
       {"", "map/update", "/%", "/%4", "/%zz", "/a%00b", "/%ff", "/%c3", "/%ed%a0%80", "?q=1", "/a?q=%00",
        "/a?%ff=1", "/a?q=%g0", "*x", "CONNECT:80"}) {
    EXPECT_FALSE(parse_target(raw)) << raw;
  }
}

TEST(Target, HasItsQueryByName) {
  const auto target = parse_target("/?a=1&b=x+y%26z&c&&d=e=f");
  ASSERT_TRUE(target);
  using Pair = std::pair<std::string, std::string>;
  const std::vector<Pair> expected = {{"a", "1"}, {"b", "x y&z"}, {"c", ""}, {"", ""}, {"d", "e=f"}};
  EXPECT_EQ(target->query, expected);
}

}  // namespace
}  // namespace adit::intake
