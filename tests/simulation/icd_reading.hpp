#pragma once

#include <string>

#include "simulation/http.hpp"

namespace adit::simulation {

/// What the ICD minds in a request to the Command Post, by the rehearsal's reading of it, which shares no
/// code with the gateway's; "": nothing.
std::string fault_of(const HttpMessage& request);

}  // namespace adit::simulation
