#pragma once

#include "api/settings_rows.hpp"
#include "api/updates.hpp"
#include "cli/ask.hpp"

namespace adit::cli {

// The functions of the commands in commands.cpp.

Result<Outcome> status(const Call& call);
Result<Outcome> watch(const Call& call);

Result<Outcome> list_alarms(const Call& call);
Result<Outcome> acknowledge(const Call& call);

Result<Outcome> list_reports(const Call& call);
Result<Outcome> show_report(const Call& call);
/// send, hold, withdraw, settle and resubmit. Asks for confirmation to send a report in doubt.
Result<Outcome> decide_on_reports(const Call& call);
Result<Outcome> correct_report(const Call& call);
Result<Outcome> compose_report(const Call& call);
Result<Outcome> export_reports(const Call& call);

Result<Outcome> list_rejected(const Call& call);
/// send and discard
Result<Outcome> decide_on_rejected(const Call& call);

Result<Outcome> show_present_run(const Call& call);
Result<Outcome> begin_run(const Call& call);
Result<Outcome> list_runs(const Call& call);
Result<Outcome> show_run(const Call& call);
Result<Outcome> print_run(const Call& call);
Result<Outcome> delete_run(const Call& call);

Result<Outcome> show_settings(const Call& call);
Result<Outcome> check_settings(const Call& call);
Result<Outcome> apply_settings(const Call& call);
Result<Outcome> set_setting(const Call& call);
Result<Outcome> export_settings(const Call& call);
/// Lists the courses, or selects one.
Result<Outcome> course(const Call& call);

/// A table: the names of tokens, whether they are set, and what is odd about them.
std::string tokens_text(const std::vector<api::TokenRow>& tokens, bool colour);
Result<Outcome> show_tokens(const Call& call);
/// Reads the token from a file, a terminal or standard input.
Result<Outcome> set_token(const Call& call);
Result<Outcome> remove_token(const Call& call);
/// Asks for the operator's present password first; on a new box for its code.
Result<Outcome> set_password(const Call& call);
/// Of the viewers.
Result<Outcome> remove_password(const Call& call);
Result<Outcome> reset_box(const Call& call);

/// Checks address and token, and saves them as a context (contexts.hpp).
Result<Outcome> log_in(const Options& options, const Console& console);
Result<Outcome> show_contexts(const Options& options, const Console& console);
Result<Outcome> use_context(const Options& options, const Console& console);
Result<Outcome> remove_context(const Options& options, const Console& console);

/// The last records; with --follow also new ones, until a signal ends it.
Result<Outcome> show_log(const Call& call);
Result<Outcome> fetch_bundle(const Call& call);
/// If Adit cannot be asked, only the version of `adit`, with the reason.
Result<Outcome> show_version(const Options& options, const Console& console);

Result<Outcome> identify(const Call& call);
Result<Outcome> show_network(const Call& call);
/// Changes addresses, until they are confirmed or time is up.
Result<Outcome> change_network(const Call& call);
/// confirm and revert. Waits for the outcome.
Result<Outcome> decide_on_network(const Call& call);
Result<Outcome> show_clock(const Call& call);
Result<Outcome> set_clock(const Call& call);

Result<Outcome> show_certificate(const Call& call);
/// From a file with the key and its certificates.
Result<Outcome> set_certificate(const Call& call);
Result<Outcome> make_certificate(const Call& call);

Result<Outcome> show_spare(const Call& call);
Result<Outcome> export_spare(const Call& call);
Result<Outcome> take_spare(const Call& call);
Result<Outcome> resume_service(const Call& call);

Result<Outcome> begin_ledger(const Call& call);
Result<Outcome> dump_ledger(const Options& options, const Console& console);

/// Starts the test, or follows a running one, and prints each finished step.
Result<Outcome> test(const Call& call);
/// Shows the update, or installs one from a file or the stick and waits for its end, or restarts the box.
Result<Outcome> update(const Call& call);
/// Lines about newer versions that apt or a stick has, or "".
std::string newer_lines(const api::UpdateView& view);

Result<Outcome> check(const Options& options, const Console& console);

Result<Outcome> complete_reports(const Call& call);
Result<Outcome> complete_rejected(const Call& call);
Result<Outcome> complete_courses(const Call& call);
Result<Outcome> complete_runs(const Call& call);
/// The settings keys; of a named one, its possible values.
Result<Outcome> complete_keys(const Options& options, const Console& console);
Result<Outcome> complete_tokens(const Call& call);
Result<Outcome> complete_alarms(const Call& call);
Result<Outcome> complete_contexts(const Options& options, const Console& console);

}  // namespace adit::cli
