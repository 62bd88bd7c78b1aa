#include "admin/setup.hpp"

#include "forward/channel.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "settings/written.hpp"

namespace adit::admin {
namespace {

using settings::Settings;

icd::Checked<void> busy_refusal() {
  return icd::refuse(icd::Status::Conflict, "another change is being applied: try again");
}

}  // namespace

std::optional<icd::BearerToken> token_for(const std::string& endpoint, const Settings& settings,
                                          const host::Secrets& secrets) {
  const std::string& course = settings.command_post.course;
  const std::string own = icd::sentence("course.", course, ".", endpoint);
  const bool has_own = !course.empty() && (secrets.tokens.contains(own) || secrets.damaged.contains(own));
  return secrets.token(has_own ? own : endpoint);
}

Setup::Setup(Store& store, FactoryReset& reset, const Store::LoadedSettings& loaded, std::string trouble,
             Meaning for_reports, std::function<void()> apply, std::function<void()> restart)
    : store_(store),
      reset_(reset),
      for_reports_(std::move(for_reports)),
      apply_(std::move(apply)),
      restart_(std::move(restart)) {
  set_running(loaded, std::move(trouble));
}

void Setup::set_running(const Store::LoadedSettings& loaded, std::string trouble) {
  settings_ = loaded.settings;
  saved_ = loaded.saved;
  trouble_ = std::move(trouble);
  tokens_.clear();
  auto odd = loaded.secrets.token_warnings();
  for (const std::string& name : token_names(settings_)) {
    const bool is_set = loaded.secrets.tokens.contains(name);
    if (is_set && odd.contains(name)) host::log(host::Level::Warning, odd[name]);
    tokens_.push_back({name, is_set, std::move(odd[name])});
  }
  applying_ = false;
}

std::vector<std::string> Setup::warnings(const Settings& next) const {
  std::vector<std::string> sentences;
  const auto now = settings::effective_settings(settings_), then = settings::effective_settings(next);
  if (now.team.listen != then.team.listen || now.team.interface != then.team.interface) {
    sentences.push_back(icd::sentence("Adit and this page move from ",
                                      icd::join_words(now.team.listen, forward::address_text), " to ",
                                      icd::join_words(then.team.listen, forward::address_text),
                                      ": open the page there, and point robots and stations there"));
  }
  if (now.command_post.scoring != then.command_post.scoring) {
    sentences.push_back(for_reports_(forward::address_text(then.command_post.scoring)));
  }
  if (now.command_post.mapping != then.command_post.mapping) {
    sentences.push_back(icd::sentence("maps, states and markers go to ",
                                      forward::address_text(then.command_post.mapping),
                                      " from then on, also the queued ones"));
  }
  if (!next.team.require_token && settings_.team.require_token) {
    sentences.emplace_back("every machine on the team's network may post reports without a token");
  }
  const bool opens_to_pages = !next.team.require_token && !next.team.origins.empty();
  if (opens_to_pages && (settings_.team.require_token || next.team.origins != settings_.team.origins)) {
    sentences.push_back(
        icd::sentence("pages of ", next.team.origins, " may post reports without a token, in any browser"));
  }
  return sentences;
}

icd::Checked<void> Setup::apply_if_written(const std::expected<void, std::string>& written, const char* what,
                                           const std::function<void()>& apply) {
  if (!written) {
    host::log(host::Level::Error, "cannot store a change", {{"what", what}, {"why", written.error()}});
    return icd::refuse(icd::Status::ServiceUnavailable, "cannot store the change: " + written.error());
  }
  host::log(host::Level::Notice, "change applied", {{"what", what}});
  applying_ = true;
  apply();
  return {};
}

icd::Checked<void> Setup::save(const Settings& next) {
  if (applying_) return busy_refusal();
  const auto changes = settings::changes(settings_, next);
  if (changes.empty() && is_kept_ && store_.unread().empty()) return {};
  for (const settings::Change& change : changes) {
    host::log(host::Level::Notice, "setting changed", {{"setting", change.path}});
  }
  const auto written = store_.save(next);
  is_kept_ = written || store_.revert();
  return apply_if_written(written, "settings", apply_);
}

icd::Checked<void> Setup::set_token(const std::string& name, const std::optional<icd::BearerToken>& token) {
  if (applying_) return busy_refusal();
  return apply_if_written(store_.save_token(name, token), "a token", apply_);
}

icd::Checked<void> Setup::reset() {
  if (applying_) return busy_refusal();
  return apply_if_written(reset_.begin(), "a factory reset", restart_);
}

}  // namespace adit::admin
