#pragma once

#include <optional>

#include "api/self_test.hpp"
#include "host/service.hpp"
#include "icd/bearer_token.hpp"
#include "settings/settings.hpp"

namespace adit::box {

/// Endpoints and tokens of a Test.
struct TestTarget {
  settings::CommandPost post;  // addresses to test, and their course
  std::optional<icd::BearerToken> scoring, mapping;
  icd::Redaction typed = icd::Redaction();  // tokens that are not stored
};

/// The written settings with the candidate, checked as if it were saved. Refused with 422 by the candidate's
/// members: "scoring.address: ...".
icd::Checked<TestTarget> tried_of(const api::Candidate& candidate, const settings::Settings& written,
                                  const host::Secrets& secrets);

}  // namespace adit::box
