#pragma once

#include <memory>
#include <string>

#include "api/route.hpp"
#include "api/updates.hpp"

namespace adit::api {

/// Updates of the box: README.md.
class UpdateRoutes {
 public:
  /// `updates` must outlive this object.
  explicit UpdateRoutes(Updates& updates) : updates_(updates) {}

  intake::Answer shown() const;
  /// Receives a bundle as a stream.
  std::unique_ptr<intake::BodySink> receive(const Call& call);
  intake::Answer install_from_stick(const std::string& body);
  intake::Answer restart(const std::string& body);
  intake::Answer go_back(const std::string& body);
  intake::Answer stay();

 private:
  /// The present state, or the refusal.
  intake::Answer after(const icd::Checked<void>& done) const;

  Updates& updates_;
};

}  // namespace adit::api
