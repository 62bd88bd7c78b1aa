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
#include "forward/fixtures.hpp"
#include "forward/sample_maps.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {

/// A mapping endpoint that answers a request once answer() gives a status.
class ManualEndpoint {
 public:
  ManualEndpoint() = default;
  ~ManualEndpoint() {
    over_ = true;
    let_.release(100);  // also ends connections that are not served yet
  }
  ManualEndpoint(const ManualEndpoint&) = delete;
  ManualEndpoint& operator=(const ManualEndpoint&) = delete;

  void answer(std::string status) {
    {
      const std::lock_guard lock(mutex_);
      answers_.push_back(std::move(status));
    }
    let_.release();
  }
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }
  /// Robots of the received maps in order.
  std::vector<std::string> received() {
    const std::lock_guard lock(mutex_);
    return received_;
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
      if (request.contains(robot)) received_.emplace_back(robot);
    }
  }
  std::string next_answer() {
    const std::lock_guard lock(mutex_);
    const std::string answer = answers_.front();
    answers_.erase(answers_.begin());
    return answer;
  }

  std::mutex mutex_;
  std::vector<std::string> received_, answers_;
  std::atomic<bool> over_ = false;
  std::counting_semaphore<> let_{0};
  uplink::ListeningPeer peer_{[this](uplink::Wire& wire) { serve(wire); }};
};

/// Maps that are sent to a ManualEndpoint.
class MapsToManualEndpoint : public testing::Test, protected MapsParts {
 protected:
  MapsToManualEndpoint() {
    settings_.command_post.rates.map_hz = 1000;
    settings_.command_post.mapping = post_.address();
    maps_.emplace(loop_, servers_, workers_, writer_, spool_, settings_, icd::BearerToken::parse("a-token"),
                  counts_, rejected_, random_, journal_, [](const icd::MapUpdate&) {});
  }
  void accept(icd::MapUpdate map) {
    bool taken = false;
    maps_->accept(std::move(map), {.bytes = 10}, nullptr,
                  [&](const icd::Checked<void>& said) { taken = said.has_value(); });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return taken; }));
  }
  bool receives(const std::vector<std::string>& robots) {
    return loop::turn_until(loop_, [&] { return post_.received() == robots; });
  }

  ManualEndpoint post_;
  std::optional<Maps> maps_;
};

}  // namespace adit::forward
