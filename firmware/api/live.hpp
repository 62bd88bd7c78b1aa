#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "api/source.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// The open pages, each fed by server-sent events (HTML Living Standard 9.2): one at once, one whenever
/// something changed (at most kEventsPerSecond), and a heartbeat that tells the page that the box is there.
class Live {
 public:
  static constexpr int kEventsPerSecond = 4;

  static constexpr std::chrono::milliseconds kHeartbeat{2000};  // a page takes 4.5 s of silence for a loss
  /// Open pages at once: forgotten ones must leave connections for the robots.
  static constexpr std::size_t kMostPages = 24;

  Live(loop::Loop& loop, const Source& source);

  /// Answers with a stream of events, or 503 where kMostPages are open. It ends once `may_stay` is false.
  void open(intake::Responder& responder, std::function<bool()> may_stay);
  void changed();

 private:
  struct OpenPage {
    std::shared_ptr<intake::Stream> stream;
    std::function<bool()> may_stay;
  };

  std::string event() const;
  void send_to_all();
  void drop_the_gone(std::string_view bytes);

  loop::Loop& loop_;
  const Source& source_;
  std::vector<OpenPage> pages_;
  loop::Source timer_;
  loop::Instant sent_;
  bool dirty_ = false;
};

}  // namespace adit::api
