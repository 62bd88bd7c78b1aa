#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "api/updates.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// The update of the box, for those whom Entrance let in: README.md.
class UpdateRoutes {
 public:
  /// `changed` is called after each action. All outlive this.
  UpdateRoutes(Updates& updates, std::function<void()> changed)
      : updates_(updates), changed_(std::move(changed)) {}

  static bool has(std::string_view path);
  /// Requires has(head.path()).
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         const std::shared_ptr<intake::Responder>& responder,
                                         std::shared_ptr<intake::Flow> flow);

 private:
  std::unique_ptr<intake::BodySink> receive(const intake::RequestHead& head,
                                            const std::shared_ptr<intake::Responder>& responder,
                                            std::shared_ptr<intake::Flow> flow);
  intake::Answer shown() const;
  intake::Answer post(std::string_view path, const std::string& body);
  /// How it stands now, or why the action was refused.
  intake::Answer after(const icd::Checked<void>& done) const;

  Updates& updates_;
  std::function<void()> changed_;
};

}  // namespace adit::api
