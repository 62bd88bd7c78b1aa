#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "api/authenticator.hpp"
#include "api/source.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::api {

/// The open pages, fed by server-sent events (HTML Living Standard 9.2). A page gets the whole view of the
/// run, then its changes (codec/patch.hpp), the same for all pages, and heartbeats. Changes come once a
/// second, those of reports or alarms at most kEventsPerSecond times. A slow page gets the whole view again.
class RunStream {
 public:
  static constexpr int kEventsPerSecond = 4;

  static constexpr std::chrono::milliseconds kHeartbeat{2000};  // a page assumes a lost connection after 4.5
                                                                // s
  /// Most open pages, so that forgotten pages leave connections for robots.
  static constexpr std::size_t kMostPages = 24;
  /// Most queued bytes for a page, beside two whole views: one in transfer and the next.
  static constexpr std::size_t kMostPatches = 64 * 1024;

  RunStream(loop::Loop& loop, Source& source);

  /// Answers with a stream of events until `has_access` returns false, or with 503 beyond kMostPages.
  void open(intake::Responder& responder, std::function<bool()> has_access);
  void on_changed();

 private:
  struct OpenPage {
    std::shared_ptr<intake::Stream> stream;
    std::function<bool()> has_access;
  };

  RunView take_view();
  void begin();
  void send_to_all(bool in_any_case);
  /// The state of the pages as an event.
  const std::string& full_state();
  bool send_event(const OpenPage& page, std::string_view event);
  void drop_closed(std::string_view event);

  loop::Loop& loop_;
  Source& source_;
  std::vector<OpenPage> pages_;
  RunView told_;                // the pages' state
  std::string whole_;           // that state as text; "": not computed
  std::size_t whole_size_ = 0;  // its last size
  loop::Source timer_;
  loop::Instant looked_, sent_;
  bool dirty_ = false;
};

/// The state of the run, and the operator's actions except those on reports.
class RunRoutes {
 public:
  static constexpr double kLeast = 1, kMost = 60;  // seconds of flashing lights

  /// All must outlive this object.
  RunRoutes(Source& source, Operator& decisions, GatewayControl& gateway_control, RunStream& live,
            Authenticator& authenticator)
      : source_(source),
        operator_(decisions),
        gateway_control_(gateway_control),
        live_(live),
        authenticator_(authenticator) {}

  RunView run() const { return source_.view(); }
  std::unique_ptr<intake::BodySink> events(const Call& call);
  intake::Answer begin_run();
  /// Replaces a ledger that cannot be read.
  intake::Answer begin_ledger();
  template <RejectedAction action>
  intake::Answer change_rejected(std::uint64_t number) {
    return change_rejected(number, action);
  }
  /// Acknowledges an alarm.
  icd::Checked<intake::Answer> acknowledge(const std::string& body);
  /// Flashes the box's lights for some seconds, to identify the box.
  icd::Checked<intake::Answer> identify(const std::string& body);

 private:
  intake::Answer change_rejected(std::uint64_t number, RejectedAction action);

  Source& source_;
  Operator& operator_;
  GatewayControl& gateway_control_;
  RunStream& live_;
  Authenticator& authenticator_;
};

}  // namespace adit::api
