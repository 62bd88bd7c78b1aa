#include "forward/uri_pace.hpp"

#include <gtest/gtest.h>

#include "host/folder.hpp"
#include "loop/loop.hpp"

namespace adit::forward {
namespace {

TEST(UriPace, StampsDoNotGoBackAfterARestart) {
  const host::Folder folder;
  loop::Loop loop;
  std::mt19937_64 random{1};
  {
    journal::Journal journal(loop, folder.path() + "/journal");
    journal.read();
    journal.begin({.boot = "b", .at = loop.now(), .stamp = loop.stamp_now()});
    UriPace pace(icd::Uri::StateUpdate, 1, random, journal);
    pace.keep_stamp(pace.next_stamp(10));
  }
  journal::Journal journal(loop, folder.path() + "/journal");
  UriPace pace(icd::Uri::StateUpdate, 1, random, journal), of_maps(icd::Uri::MapUpdate, 1, random, journal);
  const journal::HandoverState carried = journal.read();
  pace.restore(carried, loop.now());
  of_maps.restore(carried, loop.now());
  EXPECT_EQ(pace.next_stamp(8), 10);
  EXPECT_EQ(pace.next_stamp(12), 12);
  pace.restore(carried, loop.now());
  EXPECT_EQ(pace.next_stamp(11), 12);
  EXPECT_EQ(of_maps.next_stamp(8), 8) << "each URI has its own order";
}

TEST(UriPace, StampsNeverGoBack) {
  const host::Folder folder;
  loop::Loop loop;
  std::mt19937_64 random{1};
  journal::Journal journal(loop, folder.path() + "/journal");
  UriPace pace(icd::Uri::StateUpdate, 1, random, journal);
  EXPECT_EQ(pace.next_stamp(10), 10);
  EXPECT_EQ(pace.next_stamp(10.5), 10.5);
  EXPECT_EQ(pace.next_stamp(9), 10.5);
  EXPECT_EQ(pace.next_stamp(10.6), 10.6);
}

TEST(UriPace, ObeysTheRetryAfterOfA503) {
  using std::chrono::seconds;
  const host::Folder folder;
  loop::Loop loop;
  std::mt19937_64 random{1};
  journal::Journal journal(loop, folder.path() + "/journal");
  journal.begin({.boot = "b", .at = loop.now(), .stamp = loop.stamp_now()});
  const auto wait = [&](int status, std::optional<seconds> retry_after) {
    UriPace pace(icd::Uri::MapUpdate, 1, random, journal);
    pace.on_sent(loop.now());
    const auto now = loop.now();
    pace.on_failed(
        uplink::Answered{.status = status, .content_type = "", .body = "", .retry_after = retry_after}, now);
    return pace.ready() - now;
  };
  EXPECT_GE(wait(503, seconds(12)), seconds(12));
  EXPECT_LE(wait(503, seconds(12)), seconds(13));
  EXPECT_LE(wait(503, seconds(1'000'000)), seconds(30));
  EXPECT_LE(wait(503, std::nullopt), seconds(5));
  EXPECT_LE(wait(502, seconds(12)), seconds(5)) << "a proxy's";
}

}  // namespace
}  // namespace adit::forward
