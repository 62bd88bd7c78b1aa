#pragma once

#include <memory>
#include <string>

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/run.hpp"

namespace adit::rehearsal {

/// The scoring endpoint of the ICD's section 5, to the letter. At most `hz` requests a second for each URI,
/// or for both together (`one_limit`).
std::unique_ptr<Endpoint> strict_scoring(std::string token, double hz, bool one_limit, Run& run);

/// The public test server for scoring, as measured: see each rule in its source.
std::unique_ptr<Endpoint> measured_scoring(std::string token, double hz, Run& run);

/// The body of an answer to POST /api/artifact_reports (ICD 5.2). x, y, z and type are given back as they
/// came; `authority`: the address and port in its url.
OrderedJson report_body(const Run::Ruling& ruling, const Json& sent, const std::string& authority);

/// Where no address is known, or as the measured server has it.
inline constexpr const char* kNoAuthority = "<ipaddress>:<port>";

}  // namespace adit::rehearsal
