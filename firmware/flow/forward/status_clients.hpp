#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <utility>

#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::forward {

/// The clients that wait for the status of the run.
class StatusClients {
 public:
  /// A client waits so long for a new status. Then it gets the last known one.
  static constexpr std::chrono::milliseconds kWait{100};

  void add(std::shared_ptr<intake::Responder> responder, loop::Instant now) {
    waiting_.push_back({std::move(responder), now + kWait});
  }
  bool empty() const { return waiting_.empty(); }
  /// The first end of a wait.
  std::optional<loop::Instant> first_end() const {
    if (empty()) return std::nullopt;
    return std::ranges::min_element(waiting_, {}, &Client::until)->until;
  }
  /// Answers the clients whose wait ends at `now` or earlier. Instead they wait until `longest` if it is
  /// later.
  void answer_due(loop::Instant now, loop::Instant longest, const intake::Answer& answer) {
    std::erase_if(waiting_, [&](Client& client) {
      if (client.until > now) return false;
      if (longest > now) {
        client.until = longest;
        return false;
      }
      client.responder->answer(answer);
      return true;
    });
  }
  void answer_all(const intake::Answer& answer) {
    for (const Client& client : std::exchange(waiting_, {})) client.responder->answer(answer);
  }

 private:
  struct Client {
    std::shared_ptr<intake::Responder> responder;
    loop::Instant until;  // end of the wait
  };
  std::deque<Client> waiting_;
};

}  // namespace adit::forward
