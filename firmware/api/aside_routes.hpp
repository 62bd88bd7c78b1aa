#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "api/source.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// POST /adit/aside/7/send and /adit/aside/7/discard, for operators whom Entrance let in: their word on a
/// message that the Command Post would not take.
class AsideRoutes {
 public:
  /// `changed` is called after each. Both outlive this.
  AsideRoutes(Operator& judge, std::function<void()> changed)
      : operator_(judge), changed_(std::move(changed)) {}

  static bool has(std::string_view path) { return path.starts_with("/adit/aside/"); }
  /// Requires has(head.path()).
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder);

 private:
  Operator& operator_;
  std::function<void()> changed_;
};

}  // namespace adit::api
