// Changes of settings and tokens while the gateway runs.
#include <utility>

#include "box/open_panel.hpp"
#include "gateway/gateway.hpp"
#include "host/log.hpp"
#include "icd/refuse.hpp"
#include "icd/try.hpp"
#include "settings/written.hpp"

namespace adit::gateway {

/// Applies or reverts the settings on disk. If a file is unreadable, now or at the start, the next process
/// reads it.
void Gateway::apply_change() {
  if (flow_.is_ending()) return;
  const bool was_unread = !parts_.store.unread().empty();
  auto loaded = parts_.store.load();
  if (was_unread || !parts_.store.unread().empty()) {
    host::log(host::Level::Warning, "restarting: the saved settings could not be read",
              {{"why", parts_.store.unread()}});
    return make_way();
  }
  const auto done = loaded ? take_over(std::move(*loaded)) : std::unexpected(std::move(loaded.error()));
  if (!done) revert(done.error());
  api_.changed();
}

/// An error: unchanged, but sockets may be closed.
std::expected<void, std::string> Gateway::take_over(admin::Store::Loaded next) {
  settings::Settings in_use = settings::in_use(next.settings);
  settings::Restarts restarts = settings::restarts_by(settings_, in_use);
  if (restarts.listeners) {
    ADIT_TRY(listen(in_use.team));
  }
  const forward::Tokens before = tokens();
  settings_ = std::move(in_use);
  parts_.loaded = std::move(next);
  parts_.trouble.clear();
  const forward::Tokens now = tokens();
  restarts.scoring = restarts.scoring || !icd::same(before.scoring, now.scoring);
  restarts.mapping = restarts.mapping || !icd::same(before.mapping, now.mapping);
  tell_of_settings(restarts, now);
  parts_.store.settle(parts_.loaded.settings);
  parts_.sockets.settle();
  return {};
}

void Gateway::tell_of_settings(const settings::Restarts& restarts, const forward::Tokens& tokens) {
  flow_.settings_changed(restarts, tokens);
  overview_.settings_changed(restarts);
  routes_.serve_with(icd_options());
  api_.let_in(tokens.all, redaction());
  host::keep_out_of_log(redaction());
  guesses_.forget();
  links_.look_at(settings_);
  box_.runs_with(settings::file_of(parts_.loaded.settings));
  if (restarts.panel && !parts_.board.panel) reopen_panel();
  setup_.runs_with(parts_.loaded, parts_.trouble);
  self_test_.settings_changed();
}

/// A line has one holder, so the old ones are released first.
void Gateway::reopen_panel() {
  lights_.let_go();
  button_.let_go();
  auto panel =
      box::open_panel(settings_.panel, {.socket = parts_.options.panel, .folder = parts_.runtime_folder});
  lights_.take(std::move(panel.lines));
  button_.take(std::move(panel.button));
}

/// The earlier settings stay in use. If their sockets fail, the process restarts.
void Gateway::revert(const std::string& why) {
  const bool is_back = parts_.store.revert();
  parts_.trouble = (is_back ? "the last change was reverted: " : "the last change cannot be used: ") + why;
  host::log(host::Level::Error,
            is_back ? "the last change of the settings was reverted" : "the last change cannot be used",
            {{"why", why}});
  setup_.runs_with(parts_.loaded, parts_.trouble);
  if (auto listening = listen(settings_.team); !listening) return make_way();
  parts_.sockets.settle();
}

icd::Checked<std::string> Gateway::begin_ledger() {
  using enum icd::Status;
  if (!parts_.ledger.is_closed())
    return icd::refuse(Conflict, "the ledger can be read; aditd begins no other");
  auto kept_as = ledger::Ledger::set_aside(parts_.options.state);
  if (!kept_as) return icd::refuse(ServiceUnavailable, kept_as.error().what);
  host::log(host::Level::Warning, "restarting with another ledger", {{"kept_as", *kept_as}});
  make_way();
  return *std::move(kept_as);
}

}  // namespace adit::gateway
