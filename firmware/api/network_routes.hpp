#pragma once

#include <functional>

#include "api/network.hpp"
#include "api/route.hpp"
#include "api/self_test.hpp"

namespace adit::api {

/// The box's own addresses and the Test: README.md.
class NetworkRoutes {
 public:
  /// `changed` is called after each action. All outlive this.
  NetworkRoutes(Network& network, SelfTest& test, std::function<void()> changed)
      : network_(network), test_(test), changed_(std::move(changed)) {}

  intake::Answer shown() const;
  intake::Answer check(const Call& call) const;
  intake::Answer change(const Call& call);
  /// By the address that was asked.
  intake::Answer confirm(const Call& call);
  intake::Answer revert();
  intake::Answer tested() const;
  intake::Answer begin_test(const std::string& body);

 private:
  intake::Answer changed_to(const Call& call);
  /// How it stands now, or why the action was refused.
  intake::Answer after(const icd::Checked<void>& done);

  Network& network_;
  SelfTest& test_;
  std::function<void()> changed_;
};

}  // namespace adit::api
