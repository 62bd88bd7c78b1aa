#pragma once

#include "api/network.hpp"
#include "api/route.hpp"

namespace adit::api {

/// The box's addresses: README.md.
class NetworkRoutes {
 public:
  /// `network` must outlive this object.
  explicit NetworkRoutes(Network& network) : network_(network) {}

  intake::Answer check(const Call& call) const;
  intake::Answer change(const Call& call);
  /// Uses the address of the request's connection.
  intake::Answer confirm(const Call& call);

 private:
  Network& network_;
};

}  // namespace adit::api
