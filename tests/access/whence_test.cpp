#include <gtest/gtest.h>

#include "access/admission.hpp"

namespace adit::access {
namespace {

using namespace std::string_view_literals;

TEST(RequestHeaders, AcceptsOnlyHostNamesThatDnsCannotForge) {
  for (const char* host :
       {"10.0.0.1", "10.0.0.1:8000", "192.168.7.11:80", "[fd00::1]", "[fd00::1]:8000", "[::1]:1", "localhost",
        "localhost:8000", "LocalHost", "adit.local", "Adit.Local:8000", "adit12.local", "pc-17.local:8000",
        "adit.local.", "adit.local.:8000"}) {
    EXPECT_TRUE(names_this_box(host)) << host;
  }
  for (const char* host : {"",
                           ":8000",
                           "evil.example",
                           "evil.example:8000",
                           "10.0.0.1.evil.example",
                           "adit.local.evil.example",
                           ".local",
                           "a.b.local",
                           "adit_1.local",
                           "adit.local..",
                           "adit..local",
                           "adit.localx",
                           "adit",
                           "localhost.",
                           "fd00::1",
                           "[fd00::1",
                           "[10.0.0.1]",
                           "10.0.0.1:80x",
                           "10.0.0.1:123456",
                           "10.0.0",
                           "2130706433",
                           "0x7f000001",
                           "10.0.0.1:80:80",
                           "10.0.0.1 evil",
                           "[fd00::1]x"}) {
    EXPECT_FALSE(names_this_box(host)) << host;
  }
  // inet_pton() only sees the address before the NUL.
  for (const std::string_view host : {"[fd00::1\0.evil.example]"sv, "10.0.0.1\0.evil.example"sv}) {
    EXPECT_FALSE(names_this_box(host));
  }
}

TEST(RequestHeaders, ComparesHostAndPortOfAnOrigin) {
  struct Case {
    const char *origin, *host;
    bool same;
  };
  for (const auto& [origin, host, same] :
       {Case{"http://10.0.0.1:8000", "10.0.0.1:8000", true}, Case{"http://adit.local", "ADIT.local", true},
        Case{"https://adit.local", "adit.local", true}, Case{"http://[fd00::1]:8000", "[fd00::1]:8000", true},
        Case{"http://10.0.0.1:8001", "10.0.0.1:8000", false}, Case{"http://10.0.0.1", "10.0.0.1:8000", false},
        Case{"http://10.0.0.2:8000", "10.0.0.1:8000", false}, Case{"null", "10.0.0.1:8000", false},
        Case{"http://evil.example", "10.0.0.1:8000", false}, Case{"10.0.0.1:8000", "10.0.0.1:8000", false},
        Case{"file://10.0.0.1", "10.0.0.1", false}, Case{"http://", "", true}}) {
    EXPECT_EQ(is_same_origin(origin, host, false), same) << origin << ' ' << host;
  }
}

TEST(RequestHeaders, OverTlsAcceptOnlyAnOriginThatCameByTls) {
  EXPECT_TRUE(is_same_origin("https://10.0.0.1", "10.0.0.1", true));
  EXPECT_FALSE(is_same_origin("http://10.0.0.1", "10.0.0.1", true));
  EXPECT_FALSE(is_same_origin("https://10.0.0.2", "10.0.0.1", true));
}

TEST(RequestHeaders, TellWhichPortsCookieIsMeant) {
  EXPECT_EQ(cookie_name("adit", "10.0.0.1:8000", false), "adit-8000");
  EXPECT_EQ(cookie_name("adit", "[fd00::1]:8001", false), "adit-8001");
  EXPECT_EQ(cookie_name("adit", "10.0.0.1", true), "__Host-adit");
  EXPECT_EQ(cookie_name("adit", "10.0.0.1:8443", true), "__Host-adit-8443");
  for (const char* host : {"", "10.0.0.1", "adit.local", "[fd00::1]", "adit.local:", "adit.local:x"})
    EXPECT_EQ(cookie_name("adit", host, false), "adit") << host;
}

TEST(RequestHeaders, NameTheHeaderThatAProxyMustPassOn) {
  const auto why = [](const char* host, const char* origin) {
    const auto checked = check_host_and_origin(
        {.method = "GET", .host = host, .origin = origin, .cookie = {}, .authorization = {}, .csrf = {}});
    return checked ? "" : checked.error().sentence;
  };
  const std::string hint =
      "; a proxy must pass Host on (nginx: proxy_set_header Host $http_host; haproxy: no set-header Host)";
  EXPECT_EQ(
      why("127.0.0.1:8000", "http://10.0.0.9"),
      "Origin: expected a page of this box, got \"http://10.0.0.9\" with Host \"127.0.0.1:8000\"" + hint);
  EXPECT_EQ(why("adit_upstream", ""),
            "Host: expected the box's address, localhost or the box's name in .local, got \"adit_upstream\"" +
                hint);
}

TEST(RequestHeaders, FindsACookieByItsWholeName) {
  EXPECT_EQ(cookie_in("adit=1", "adit"), "1");
  EXPECT_EQ(cookie_in("theme=dark; adit=1; x=2", "adit"), "1");
  EXPECT_EQ(cookie_in("theme=dark;adit=1 ", "adit"), "1");
  EXPECT_EQ(cookie_in("adit=1; adit=2", "adit"), "1");
  EXPECT_EQ(cookie_in("adit=a=b", "adit"), "a=b");
  for (const char* cookies :
       {"", "adit", "xadit=1", "adit2=1", "Adit=1", ";;;", " ; =", "x=adit=1", "adit="}) {
    EXPECT_EQ(cookie_in(cookies, "adit"), "") << cookies;
  }
}

TEST(CookiesIn, AreThoseOfTheHostsPortAndThenOfOtherPorts) {
  const auto values = cookies_in("adit-device=d; adit-80=b; adit=a; adit-8080=c; adit-x=e; aditx=f", "adit",
                                 "10.0.0.1:8080", false);
  EXPECT_EQ(values, (std::vector<std::string_view>{"c", "b", "a"}));
  EXPECT_EQ(cookies_in("adit-8000=b", "adit", "10.0.0.1:8080", false),
            (std::vector<std::string_view>{"", "b"}))
      << "the box has moved to another port";
}

TEST(CookiesIn, AreOfAnotherSessionWithTlsAndWithoutIt) {
  constexpr std::string_view kBoth = "adit=a; __Host-adit=b";
  EXPECT_EQ(cookies_in(kBoth, "adit", "10.0.0.1", false), (std::vector<std::string_view>{"a"}));
  EXPECT_EQ(cookies_in(kBoth, "adit", "10.0.0.1", true), (std::vector<std::string_view>{"b"}));
  EXPECT_EQ(cookies_in("adit=a", "adit", "10.0.0.1", true), (std::vector<std::string_view>{""}));
}

}  // namespace
}  // namespace adit::access
