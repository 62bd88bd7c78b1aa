#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/source.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// The open pages, each fed by server-sent events (HTML Living Standard 9.2): first the view of the run
/// whole, then, as it changes (at most kEventsPerSecond), what it changes by (codec/patch.hpp), the same to
/// all; and a heartbeat that tells the page that the box is there. A page that is slow is told the whole view
/// again where more waits for it than that.
class Live {
 public:
  static constexpr int kEventsPerSecond = 4;

  static constexpr std::chrono::milliseconds kHeartbeat{2000};  // a page takes 4.5 s of silence for a loss
  /// Open pages at once: forgotten ones must leave connections for the robots.
  static constexpr std::size_t kMostPages = 24;
  /// Bytes that wait for a page, beside two whole views: the one that it takes, and the one after it.
  static constexpr std::size_t kMostPatches = 64 * 1024;

  Live(loop::Loop& loop, const Source& source);

  /// Answers with a stream of events, or 503 where kMostPages are open. It ends once `may_stay` is false.
  void open(intake::Responder& responder, std::function<bool()> may_stay);
  void changed();

 private:
  struct OpenPage {
    std::shared_ptr<intake::Stream> stream;
    std::function<bool()> may_stay;
  };

  RunView look() const;
  void begin();
  void send_to_all(bool in_any_case);
  /// All that the pages were told, as an event.
  const std::string& whole();
  bool tell(const OpenPage& page, std::string_view event);
  void drop_the_gone(std::string_view event);

  loop::Loop& loop_;
  const Source& source_;
  std::vector<OpenPage> pages_;
  RunView told_;                // what the pages have
  std::string whole_;           // that; "": nobody needed it yet
  std::size_t whole_size_ = 0;  // when somebody last did
  loop::Source timer_;
  loop::Instant looked_, sent_;
  bool dirty_ = false;
};

}  // namespace adit::api
