#pragma once

#include <functional>
#include <memory>
#include <string>

#include "api/route.hpp"
#include "api/updates.hpp"

namespace adit::api {

/// The update of the box: README.md.
class UpdateRoutes {
 public:
  /// `changed` is called after each action. All outlive this.
  UpdateRoutes(Updates& updates, std::function<void()> changed)
      : updates_(updates), changed_(std::move(changed)) {}

  intake::Answer shown() const;
  /// Takes a bundle as it comes.
  std::unique_ptr<intake::BodySink> receive(const Call& call);
  intake::Answer install_from_stick(const std::string& body);
  intake::Answer restart(const std::string& body);
  intake::Answer go_back(const std::string& body);
  intake::Answer stay();

 private:
  /// How it stands now, or why the action was refused.
  intake::Answer after(const icd::Checked<void>& done);

  Updates& updates_;
  std::function<void()> changed_;
};

}  // namespace adit::api
