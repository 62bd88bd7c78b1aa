#include "box/candidate.hpp"

#include <string_view>

#include "admin/setup.hpp"
#include "settings/written.hpp"

namespace adit::box {
namespace {

using Endpoint = std::optional<api::Candidate::Endpoint>;

void put(const Endpoint& typed, settings::Address& address) {
  if (!typed) return;
  address.address = typed->address.value_or(address.address);
  address.port = typed->port.value_or(address.port);
}

/// Names errors by the candidate's members.
icd::Refusal unfit(std::vector<settings::Error> errors) {
  constexpr std::string_view kOwn = "command_post.";
  for (settings::Error& error : errors) {
    if (error.path.starts_with(kOwn)) error.path.erase(0, kOwn.size());
  }
  return {icd::Status::UnprocessableEntity, settings::sentence_of(errors)};
}

std::optional<icd::BearerToken> token_of(const char* name, const Endpoint& typed,
                                         const settings::Settings& settings, const host::Secrets& secrets,
                                         icd::Redaction& redaction) {
  if (!typed || !typed->token) return admin::token_for(name, settings, secrets);
  redaction.add(*typed->token);
  return typed->token;
}

}  // namespace

icd::Checked<TestTarget> tried_of(const api::Candidate& candidate, const settings::Settings& written,
                                  const host::Secrets& secrets) {
  settings::Settings next = written;
  if (candidate.course) next.command_post.course = *candidate.course;
  const auto known = settings::parse(settings::value_of(next));  // checks the course
  if (!known) return std::unexpected(unfit(known.error()));
  const settings::Settings in_use = settings::in_use(*known);
  // Clears the course, which would replace these addresses.
  next.command_post = in_use.command_post;
  put(candidate.scoring, next.command_post.scoring);
  put(candidate.mapping, next.command_post.mapping);
  const auto checked = settings::parse(settings::value_of(next));
  if (!checked) return std::unexpected(unfit(checked.error()));
  TestTarget tried{.post = checked->command_post, .scoring = {}, .mapping = {}};
  tried.scoring = token_of("scoring", candidate.scoring, in_use, secrets, tried.typed);
  tried.mapping = token_of("mapping", candidate.mapping, in_use, secrets, tried.typed);
  return tried;
}

}  // namespace adit::box
