#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <utility>
#include <vector>

#include "../uplink/peer.hpp"
#include "forward/around.hpp"
#include "forward/maps.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {

inline icd::MapUpdate grid_of(const char* robot, std::uint32_t side) {
  icd::OccupancyGrid grid;
  grid.header.stamp = 1;
  grid.resolution = 0.25;
  grid.width = grid.height = side;
  const std::vector<std::uint8_t> cells(std::size_t{side} * side, 1);
  return {
      icd::RobotName::parse(robot), grid, {icd::ChunkedBytes{cells}, icd::Compression::None, cells.size()}};
}

/// A mapping endpoint that says each time what it is let say.
class LettingPost {
 public:
  LettingPost() = default;
  ~LettingPost() {
    over_ = true;
    let_.release(100);  // also for a connection that waits to be served
  }
  LettingPost(const LettingPost&) = delete;
  LettingPost& operator=(const LettingPost&) = delete;

  void answer(std::string status) {
    {
      const std::lock_guard lock(mutex_);
      answers_.push_back(std::move(status));
    }
    let_.release();
  }
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }
  /// The robots of the maps that came, in order.
  std::vector<std::string> came() {
    const std::lock_guard lock(mutex_);
    return came_;
  }

 private:
  void serve(uplink::Wire& wire) {
    for (auto request = wire.read_request(); !request.empty(); request = wire.read_request()) {
      note(request);
      let_.acquire();
      if (over_ || !wire.write(uplink::answer(next_answer(), "null"))) return;
    }
  }
  void note(const std::string& request) {
    const std::lock_guard lock(mutex_);
    for (const char* robot : {"first", "second", "third"}) {
      if (request.contains(robot)) came_.emplace_back(robot);
    }
  }
  std::string next_answer() {
    const std::lock_guard lock(mutex_);
    const std::string answer = answers_.front();
    answers_.erase(answers_.begin());
    return answer;
  }

  std::mutex mutex_;
  std::vector<std::string> came_, answers_;
  std::atomic<bool> over_ = false;
  std::counting_semaphore<> let_{0};
  uplink::ListeningPeer peer_{[this](uplink::Wire& wire) { serve(wire); }};
};

/// Maps on their way to it.
class WithLettingPost : public testing::Test, protected AroundMaps {
 protected:
  WithLettingPost() {
    settings_.command_post.rates.map_hz = 1000;
    settings_.command_post.mapping = post_.address();
    maps_.emplace(loop_, workers_, writer_, spool_, settings_, icd::BearerToken::parse("a-token"), record_,
                  rejected_, random_, journal_, [](const icd::MapUpdate&) {});
  }
  void take(icd::MapUpdate map) {
    bool taken = false;
    maps_->take(std::move(map), 10, nullptr,
                [&](const icd::Checked<void>& said) { taken = said.has_value(); });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return taken; }));
  }
  bool come(const std::vector<std::string>& robots) {
    return loop::turn_until(loop_, [&] { return post_.came() == robots; });
  }

  LettingPost post_;
  std::optional<Maps> maps_;
};

}  // namespace adit::forward
