#pragma once

#include <string>

#include "simulation/http.hpp"

namespace adit::simulation {

/// The violation of the ICD in a request to the Command Post, or "". Uses the rehearsal's reading of the
/// ICD, which shares no code with the gateway's.
std::string fault_of(const HttpMessage& request);

}  // namespace adit::simulation
