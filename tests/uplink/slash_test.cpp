#include "asking.hpp"
#include "uplink/exchange.hpp"

namespace adit::uplink {
namespace {

constexpr const char* kAuthority = "10.100.1.201:8000";

struct Redirect {
  int status;
  const char *location, *authority, *target;
  std::optional<bool> expected;
};

TEST(SlashRedirect, AddsOrRemovesOnlyASlash) {
  for (const Redirect& each : {
           Redirect{301, "/map/update/", kAuthority, "/map/update", true},
           {302, "/map/update/", kAuthority, "/map/update", true},
           {307, "/map/update/", kAuthority, "/map/update", true},
           {308, "/map/update/", kAuthority, "/map/update", true},
           {308, "http://10.100.1.201:8000/map/update/", kAuthority, "/map/update", true},
           {308, "HTTP://10.100.1.201:8000/map/update/", kAuthority, "/map/update", true},
           {308, "http://10.100.1.201/map/update/", "10.100.1.201:80", "/map/update", true},
           {308, "http://10.100.1.201:80/map/update/", "10.100.1.201:80", "/map/update", true},
           {308, "http://[FE80::A]:8000/map/update/", "[fe80::a]:8000", "/map/update", true},
           {308, "http://[fe80::a]/map/update/", "[fe80::a]:80", "/map/update", true},
           // Another status.
           {200, "/map/update/", kAuthority, "/map/update", {}},
           {201, "/map/update/", kAuthority, "/map/update", {}},
           {300, "/map/update/", kAuthority, "/map/update", {}},
           {303, "/map/update/", kAuthority, "/map/update", {}},
           {304, "/map/update/", kAuthority, "/map/update", {}},
           {404, "/map/update/", kAuthority, "/map/update", {}},
           // Another place.
           {308, "http://10.100.1.200:8000/map/update/", kAuthority, "/map/update", {}},
           {308, "http://10.100.1.201:8001/map/update/", kAuthority, "/map/update", {}},
           {308, "http://10.100.1.201/map/update/", kAuthority, "/map/update", {}},
           {308, "http://[fe80::a]:8000/map/update/", "[fe80::b]:8000", "/map/update", {}},
           {308, "http://10.100.1.201:8000.evil.example/map/update/", kAuthority, "/map/update", {}},
           {308, "http://user@10.100.1.201:8000/map/update/", kAuthority, "/map/update", {}},
           {308, "http://10.100.1.201:8000@evil.example/map/update/", kAuthority, "/map/update", {}},
           {308, "//10.100.1.201:8000/map/update/", kAuthority, "/map/update", {}},
           {308, "//evil.example/map/update/", kAuthority, "/map/update", {}},
           // Another scheme.
           {308, "https://10.100.1.201:8000/map/update/", kAuthority, "/map/update", {}},
           {308, "ftp://10.100.1.201:8000/map/update/", kAuthority, "/map/update", {}},
           // Another path.
           {308, "", kAuthority, "/map/update", {}},
           {308, "/", kAuthority, "/map/update", {}},
           {308, "/map/update", kAuthority, "/map/update", {}},
           {308, "/map/update//", kAuthority, "/map/update", {}},
           {308, "/Map/update/", kAuthority, "/map/update", {}},
           {308, "/map/update/?", kAuthority, "/map/update", {}},
           {308, "/map/update/?next=/", kAuthority, "/map/update", {}},
           {308, "/map/update/#/", kAuthority, "/map/update", {}},
           {308, "/map/update?/", kAuthority, "/map/update", {}},
           {308, "/map/../map/update/", kAuthority, "/map/update", {}},
           {308, "/state/update/", kAuthority, "/map/update", {}},
           {308, "map/update/", kAuthority, "/map/update", {}},
           {308, "update/", kAuthority, "/map/update", {}},
           {308, "http://10.100.1.201:8000", kAuthority, "/map/update", {}},
           {308, "http://10.100.1.201:8000?/map/update/", kAuthority, "/map/update", {}},
           {308, "http://", kAuthority, "/map/update", {}},
           {308, "http:///map/update/", kAuthority, "/map/update", {}},
           // Without the slash.
           {308, "/map/update", kAuthority, "/map/update/", false},
           {301, "http://10.100.1.201:8000/map/update", kAuthority, "/map/update/", false},
           {308, "http://10.100.1.200:8000/map/update", kAuthority, "/map/update/", {}},
           {303, "/map/update", kAuthority, "/map/update/", {}},
           {308, "/map/updat", kAuthority, "/map/update/", {}},
           {308, "", kAuthority, "/", {}},
           // It has one.
           {308, "/map/update//", kAuthority, "/map/update/", {}},
           {308, "/map/update/", kAuthority, "/map/update/", {}},
       }) {
    EXPECT_EQ(redirects_to_slash(each.status, each.location, each.authority, each.target), each.expected)
        << each.status << ' ' << each.location << " of " << each.target << " at " << each.authority;
  }
}

class RedirectAnswer : public Asking {
 protected:
  bool wants_slash(const std::string& fields) {
    const ListeningPeer peer(always(answer("308 Permanent Redirect", "<html>", fields)));
    return answered(ask(peer.endpoint(), post("a map"))).wants_slash == true;
  }
};

TEST_F(RedirectAnswer, TellsTheSlashByItsLocation) {
  EXPECT_TRUE(wants_slash("Location: /map/update/\r\n"));
  EXPECT_TRUE(wants_slash("location:/map/update/ \r\n"));
  EXPECT_FALSE(wants_slash(""));
  EXPECT_FALSE(wants_slash("Location: http://127.0.0.1:1/map/update/\r\n"));
}

TEST_F(RedirectAnswer, IsComparedWithTheRequestedTarget) {
  const ListeningPeer peer([](Wire& wire) { wire.write(without_slash(wire.read_request())); });
  EXPECT_TRUE(answered(ask(peer.endpoint(), post("a map"))).wants_slash);
}

}  // namespace
}  // namespace adit::uplink
