#pragma once

#include "api/network.hpp"
#include "api/route.hpp"
#include "api/self_test.hpp"

namespace adit::api {

/// The box's addresses and the Test: README.md.
class NetworkRoutes {
 public:
  /// Both must outlive this object.
  NetworkRoutes(Network& network, SelfTest& test) : network_(network), test_(test) {}

  intake::Answer shown() const;
  intake::Answer check(const Call& call) const;
  intake::Answer change(const Call& call);
  /// Uses the address of the request's connection.
  intake::Answer confirm(const Call& call);
  intake::Answer revert();
  intake::Answer tested() const;
  intake::Answer begin_test(const std::string& body);

 private:
  /// The present state, or the refusal.
  intake::Answer after(const icd::Checked<void>& done) const;

  Network& network_;
  SelfTest& test_;
};

}  // namespace adit::api
