#pragma once

#include <memory>
#include <string>

#include "api/route.hpp"
#include "api/spare.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Spare and standby. Routes: README.md. `spare` must outlive the answers.
namespace spare_routes {

void exported(Spare& spare, const Call& call);
void to_stick(Spare& spare, const Call& call);
std::unique_ptr<intake::BodySink> take_in(Spare& spare, const Call& call);
void open(Spare& spare, const Call& call);
intake::Answer take_over(Spare& spare, const std::string& body);

}  // namespace spare_routes
}  // namespace adit::api
