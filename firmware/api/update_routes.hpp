#pragma once

#include <memory>
#include <string>

#include "api/route.hpp"
#include "api/updates.hpp"

namespace adit::api {

/// The update of the box: README.md.
class UpdateRoutes {
 public:
  /// `updates` outlives this.
  explicit UpdateRoutes(Updates& updates) : updates_(updates) {}

  intake::Answer shown() const;
  /// Takes a bundle as it comes.
  std::unique_ptr<intake::BodySink> receive(const Call& call);
  intake::Answer install_from_stick(const std::string& body);
  intake::Answer restart(const std::string& body);
  intake::Answer go_back(const std::string& body);
  intake::Answer stay();

 private:
  /// How it stands now, or why the action was refused.
  intake::Answer after(const icd::Checked<void>& done) const;

  Updates& updates_;
};

}  // namespace adit::api
