#pragma once

#include <memory>
#include <string_view>

#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// POST /adit/identify, for operators whom Entrance let in: the box's lights blink for some seconds, so that
/// it can be told from others.
class PanelRoute {
 public:
  static constexpr double kLeast = 1, kMost = 60;  // seconds

  /// `judge` outlives this.
  explicit PanelRoute(Operator& judge) : operator_(judge) {}

  static bool has(std::string_view path) { return path == "/adit/identify"; }
  /// Requires has(head.path()).
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder);

 private:
  intake::Answer identify(std::string_view body);

  Operator& operator_;
};

}  // namespace adit::api
