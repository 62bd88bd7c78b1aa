#pragma once

#include "api/network.hpp"
#include "api/route.hpp"

namespace adit::api {

/// The box's addresses: README.md.
namespace network_routes {

intake::Answer check(Network& network, const Call& call);
intake::Answer change(Network& network, const Call& call);
/// Uses the address of the request's connection.
intake::Answer confirm(Network& network, const Call& call);

}  // namespace network_routes
}  // namespace adit::api
