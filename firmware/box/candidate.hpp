#pragma once

#include <optional>

#include "api/self_test.hpp"
#include "host/service.hpp"
#include "icd/bearer_token.hpp"
#include "icd/redaction.hpp"
#include "settings/settings.hpp"

namespace adit::box {

/// What a Test asks, and with which tokens.
struct Tried {
  settings::CommandPost post;  // with the addresses to ask; `course`: whose they are
  std::optional<icd::BearerToken> scoring, mapping;
  icd::Redaction typed = icd::Redaction();  // the tokens of these that are kept nowhere
};

/// What a candidate comes to beside the settings as they are written, which have to be right with it as if it
/// were saved. Refused with 422, each error by the candidate's member: "scoring.address: ...".
icd::Checked<Tried> tried_of(const api::Candidate& candidate, const settings::Settings& written,
                             const host::Secrets& secrets);

}  // namespace adit::box
