// Memory that runs out while a map is packed, or while its answer is taken: the map goes up all the same.
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <semaphore>

#include "../uplink/peer.hpp"
#include "forward/around.hpp"
#include "forward/maps.hpp"
#include "host/folder.hpp"
#include "loop/guard.hpp"
#include "loop/turn_until.hpp"
#include "scarce_memory.hpp"
#include "spool/messages.hpp"

namespace adit::forward {
namespace {

namespace fs = std::filesystem;
using spool::cloud;

/// The answers of a Command HeldPost to one map after the other, each once the test lets it; without any left
/// it takes what comes.
struct HeldPost {
  void serve(uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      ++requests;
      if (held) let.acquire();
      const bool first = !odd.empty() && !said_odd.exchange(true);
      if (!wire.write(first ? odd : uplink::answer("200 OK", "null"))) return;
    }
  }
  std::string odd;  // the first answer; "": as all others
  std::atomic<bool> said_odd = false, held = true;
  std::atomic<int> requests = 0;
  std::counting_semaphore<> let{0};
};

class MapsWithoutMemory : public testing::TestWithParam<std::tuple<std::string, std::size_t>>,
                          protected AroundMaps {
 protected:
  MapsWithoutMemory() {
    settings_.command_post.rates.map_hz = 1e9;  // the next one is packed in the same turn
    settings_.command_post.mapping = {peer_.endpoint().address, peer_.endpoint().port};
    maps_.emplace(loop_, workers_, writer_, spool_, settings_, icd::BearerToken::parse("a-token"), record_,
                  rejected_, random_, journal_, [](const icd::MapUpdate&) {});
    journal_.begin({.boot = "b", .at = loop_.now(), .stamp = loop_.stamp_now()});
  }
  ~MapsWithoutMemory() override {
    post_.held = false;
    post_.let.release(1000);
  }

  template <class Done>
  bool comes(Done done) {
    const auto end = loop_.now() + std::chrono::seconds{20};
    while (!done() && loop_.now() < end) {
      loop_.turn(std::chrono::milliseconds{2});
      maps_->link_is_back();  // after failures it is tried again at once
    }
    return done();
  }
  void take(icd::MapUpdate map) {
    std::optional<bool> said;
    maps_->take(std::move(map), 10, nullptr,
                [&](const icd::Checked<void>& taken) { said = taken.has_value(); });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return said.has_value(); }));
    ASSERT_EQ(said, true);
  }
  bool nothing_waits() const {
    std::error_code none;
    std::size_t files = 0;
    for (const auto& entry : fs::directory_iterator(folder_.path(), none)) {
      files += entry.path().extension() == ".cbor" ? 1 : 0;
    }
    return files == 0 && maps_->queued_bytes() == 0 && !maps_->channel().busy() &&
           maps_->waiting({Kind::Cloud, "r1"}) == 0;
  }

  HeldPost post_;
  uplink::ListeningPeer peer_{[this](uplink::Wire& wire) { post_.serve(wire); }};
  std::optional<Maps> maps_;
};

/// While one is answered another one waits, which is then packed.
TEST_P(MapsWithoutMemory, LoseAtMostTheAnswerAndAllArrive) {
  const auto& [odd, count] = GetParam();
  post_.odd = odd;
  for (std::size_t n = 0;; ++n) {
    SCOPED_TRACE(n);
    post_.said_odd = false;
    post_.held = true;
    const int before = post_.requests;
    take(cloud(10));
    ASSERT_TRUE(comes([&] { return post_.requests > before; }));
    take(cloud(20));
    const std::uint64_t caught = loop::caught_so_far();
    post_.let.release();
    ScarceMemory scarce(n, count);
    while (maps_->channel().busy() && post_.requests < before + 2 && ScarceMemory::failed() == 0)
      loop_.turn(std::chrono::milliseconds{2});
    const std::size_t failed = scarce.end();
    if (count == 1) {
      EXPECT_EQ(loop::caught_so_far() - caught, failed);
    }
    post_.held = false;
    post_.let.release();
    ASSERT_TRUE(comes([&] { return nothing_waits(); })) << post_.requests;
    while (post_.let.try_acquire()) {
    }
    if (failed == 0) return;
  }
}

std::string name_of_case(const testing::TestParamInfo<std::tuple<std::string, std::size_t>>& test) {
  const char* const kinds[] = {"Taken", "Failed", "Foreign", "Refused"};
  return std::string(kinds[test.index / 2]) + (test.index % 2 == 0 ? "Once" : "AtAll");
}

INSTANTIATE_TEST_SUITE_P(
    WhateverTheAnswer, MapsWithoutMemory,
    testing::Combine(testing::Values("", uplink::answer("500 Oops", "\"a handler that fails\""),
                                     uplink::answer("200 OK", "<html>a captive portal</html>"),
                                     uplink::answer("422 No", "\"msg.fields: not these\"")),
                     testing::Values(std::size_t{1}, ScarceMemory::kAll)),
    name_of_case);

}  // namespace
}  // namespace adit::forward
