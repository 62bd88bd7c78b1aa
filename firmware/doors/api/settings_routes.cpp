#include "api/settings_routes.hpp"

#include <algorithm>
#include <optional>

#include "api/answers.hpp"
#include "api/route.hpp"
#include "api/settings_rows.hpp"
#include "codec/field.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::api {
namespace {

using codec::Field;
using codec::Value;

constexpr std::size_t kShortestTeamToken = 8;

/// Settings to save or check, perhaps invalid, and the version they are based on.
struct PostedSettings {
  Value settings;
  std::string base;
};

icd::Checked<PostedSettings> read_posted(const std::string& body, bool with_base) {
  return read_body<PostedSettings>(body, [with_base](const Field& root) {
    PostedSettings posted;
    const Field settings = root.member("settings");
    if (!settings.is<Value::Object>()) settings.refuse_kind("an object");
    if (with_base) posted.base = root.member("base").text();
    if (settings.value() != nullptr) posted.settings = *settings.value();
    return posted;
  });
}

/// Errors that a file may have, but a saved form may not: port 0, which changes with each start.
std::vector<settings::Error> unfit_to_save(const settings::Settings& now, const settings::Settings& next) {
  std::vector<settings::Error> errors;
  for (std::size_t i = 0; i < next.team.listen.size(); ++i) {
    const settings::Address& listen = next.team.listen[i];
    if (listen.port != 0 || std::ranges::find(now.team.listen, listen) != now.team.listen.end()) continue;
    errors.push_back({icd::sentence("team.listen[", i, "].port"),
                      "expected 1 to 65535, got 0: the address of this page would be unknown"});
  }
  return errors;
}

struct PostedToken {
  std::string name;
  std::optional<icd::BearerToken> token;
};

icd::Checked<PostedToken> read_token(const std::string& body) {
  return read_body<PostedToken>(body, [](const Field& root) {
    PostedToken posted{.name = std::string(root.member("name").text()), .token = {}};
    const Field token = root.member("token");
    if (token.is<std::nullptr_t>()) return posted;
    posted.token = icd::BearerToken::parse(token.text());
    if (!posted.token) token.refuse("expected null or 1 to 256 visible ASCII characters");
    // The Command Post chooses the other tokens.
    if (posted.token && posted.name == "team" && posted.token->reveal().size() < kShortestTeamToken) {
      token.refuse("expected at least ", kShortestTeamToken,
                   " characters, because the token has the password's rights");
    }
    return posted;
  });
}

/// Answers with the changes.
intake::Answer apply(Setup& setup, const settings::Settings& next) {
  const auto changes = settings::changes(setup.settings(), next);
  const auto warnings = setup.warnings(next);
  if (const auto saved = setup.save(next); !saved) return refused_change(saved.error());
  return uncached_answer(ChangesView{changes, warnings});
}

}  // namespace

namespace settings_routes {

intake::Answer export_settings(const Setup& setup) {
  return download(uncached_answer("application/json", settings::file_of(setup.settings())),
                  "adit-settings.json");
}

icd::Checked<CheckView> check(const Setup& setup, const std::string& body) {
  const auto posted = ADIT_TRY(read_posted(body, false));
  const auto next = settings::parse(posted.settings);
  if (!next) return CheckView{.errors = next.error(), .changes = {}};
  const auto unfit = unfit_to_save(setup.settings(), *next);
  if (!unfit.empty()) return CheckView{.errors = unfit, .changes = {}};
  return CheckView{.errors = {},
                   .changes = {settings::changes(setup.settings(), *next), setup.warnings(*next)}};
}

icd::Checked<intake::Answer> save(Setup& setup, const std::string& body) {
  const auto posted = ADIT_TRY(read_posted(body, true));
  if (posted.base != settings::tag_of(setup.settings())) {
    return refusal(icd::Status::Conflict, "another user has changed the settings meanwhile: reload them");
  }
  const auto next = settings::parse(posted.settings);
  if (!next) return refusal_answer(next.error());
  const auto unfit = unfit_to_save(setup.settings(), *next);
  if (!unfit.empty()) return refusal_answer(unfit);
  return apply(setup, *next);
}

intake::Answer switch_course(Setup& setup, const std::string& name) {
  settings::Settings next = setup.settings();
  next.command_post.course = name;
  const auto checked = settings::parse(settings::value_of(next));
  if (!checked) return refusal_answer(checked.error());
  return apply(setup, *checked);
}

icd::Checked<intake::Answer> set_token(Setup& setup, const std::string& body) {
  const auto posted = ADIT_TRY(read_token(body));
  const auto rows = setup.tokens();
  if (std::ranges::find(rows, posted.name, &TokenRow::name) == rows.end())
    return icd::unprocessable("name: expected one of ", icd::join_words(rows, &TokenRow::name), ", got ",
                              icd::quote_text(posted.name));
  if (const auto kept = setup.set_token(posted.name, posted.token); !kept)
    return refused_change(kept.error());
  return object({{"name", {posted.name}}, {"set", {posted.token.has_value()}}});
}

}  // namespace settings_routes
}  // namespace adit::api
