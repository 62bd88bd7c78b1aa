#include "api/spare.hpp"

#include <chrono>
#include <fstream>

#include "api/reports_csv.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "spare/sealed.hpp"

namespace adit::cli {
namespace {

using api::SpareView;

constexpr const char* kSpare = "/adit/spare";
constexpr const char* kSeeSpare = "adit spare";
constexpr std::chrono::seconds kFileWithin{60};

/// Waits for a busy or restarting box. The stick may be slow, and another request may come first.
PollPolicy box_waiting(std::chrono::seconds within) {
  return {.within = within,
          .every = std::chrono::milliseconds(300),
          .may_be_away = true,
          .late = "the box has not finished: see adit spare"};
}

std::string text_of(const api::ExportRow& row) {
  std::string out = line("From the box at ", row.name, " (Adit ", row.version, "), on standby since ",
                         api::iso_time(row.at), " by its clock") +
                    line("  ", row.reports, " reports, ", row.open,
                         " of them unfinished, for the Command Post at ", row.post);
  if (row.run) out += line("  score ", row.run->score, ", ", row.run->remaining_reports, " reports left");
  if (row.port != 0) out += line("  team's port ", row.port, ", at this box after the take-over");
  for (const std::string& path : row.left_out)
    out += line("  left out, because this version does not know it: ", path);
  return out;
}

std::string text_of(const api::StickRow& stick, bool standby) {
  std::string out;
  if (!stick.doing.empty()) out += line("The stick: ", stick.doing);
  if (!stick.refusal.empty()) out += line("The stick: ", stick.refusal);
  if (!stick.unreadable.empty()) out += line("The stick: ", stick.unreadable);
  if (standby && !stick.written.empty())
    out += line("Its export is on the stick, which you may now unplug: ", stick.written);
  for (const api::StickExportRow& each : stick.exports) {
    if (!standby || each.name != stick.written) out += line("On the stick: ", each.name);
  }
  return out;
}

std::string text_of(const SpareView& view, bool /*colour*/) {
  std::string out;
  if (view.standby) out += line("This box is on standby: ", view.why);
  if (!view.code.empty()) out += line("Code of its export: ", view.code);
  if (view.takes_over) out += line("This box is taking over");
  if (view.asks_code) out += line("An export was imported, and needs its code");
  if (view.taken_in) out += text_of(*view.taken_in);
  if (view.stick) out += text_of(*view.stick, view.standby);
  return out.empty() ? line("This box is in service") : out;
}

Result<SpareView> put_on_standby(const Call& call) {
  ADIT_TRY(confirm(call.options, call.console,
                   "On standby, this box accepts and sends no messages. Queued reports are part "
                   "of the export; queued maps, states and markers stay here.",
                   "Put it on standby?"));
  ADIT_TRY(post(call.adit, {.target = "/adit/spare/standby", .check = kSeeSpare}));
  auto told = ADIT_TRY(
      fetch_until<SpareView>(call.adit, kSpare, box_waiting(std::chrono::seconds(60)),
                             [](const SpareView& seen) { return seen.standby && !seen.code.empty(); }));
  return std::move(told.row);
}

/// Requests an action on the stick and waits for its end.
Result<SpareView> ask_stick(const Adit& adit, const char* target, const std::string& body) {
  ADIT_TRY(post(adit, {.target = target, .check = kSeeSpare, .body = body}));
  auto told = ADIT_TRY(
      fetch_until<SpareView>(adit, kSpare, box_waiting(std::chrono::seconds(330)),
                             [](const SpareView& seen) { return !seen.stick || seen.stick->doing.empty(); }));
  const auto& stick = told.row.stick;
  if (!stick) return to_failure("adit-spare is not running");
  if (!stick->refusal.empty()) return to_failure(stick->refusal, Exit::Attention);
  return std::move(told.row);
}

/// The stick's state before a request.
Result<api::StickRow> stick_of(const Adit& adit) {
  auto told = ADIT_TRY(fetch<SpareView>(adit, kSpare));
  if (told.row.stick) return *std::move(told.row.stick);
  return to_failure("this box cannot use a stick: name a file");
}

/// `where`: place of the export.
Outcome on_standby(const Call& call, const SpareView& view, const std::string& where) {
  return print_result(call, codec::to_json(view),
                      line("This box is on standby. Its export is ", where) +
                          line("Code of its export: ", view.code) +
                          line("Unplug this box before the spare takes over."));
}

Result<Outcome> write_to_stick(const Call& call) {
  const auto stick = ADIT_TRY(stick_of(call.adit));
  if (!stick.hindrance.empty())
    return to_failure("the box was not put on standby: " + stick.hindrance, Exit::Attention);
  ADIT_TRY(put_on_standby(call));
  const auto view = ask_stick(call.adit, "/adit/spare/to-stick", "");
  if (!view)
    return to_failure("the box is on standby, but its export is not on the stick: " + view.error().sentence,
                      view.error().exit);
  return on_standby(call, *view, "on the stick, which you may now unplug: " + view->stick->written);
}

Result<std::string> read_export(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(spare::kLargestExport + 1, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.is_open() || file.bad()) return to_failure(path + ": cannot be read");
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (bytes.size() > spare::kLargestExport) return to_failure(path + ": too large for an export");
  if (const std::string why = spare::export_error(bytes); !why.empty()) return to_failure(path + ": " + why);
  return bytes;
}

/// The name of the stick's export to use.
Result<std::string> name_on_stick(const Call& call) {
  if (!call.options.argument().empty()) return call.options.argument();
  const auto stick = ADIT_TRY(stick_of(call.adit));
  if (stick.exports.size() == 1) return stick.exports.front().name;
  if (!stick.unreadable.empty()) return to_failure(stick.unreadable, Exit::Attention);
  std::string why = stick.exports.empty() ? "the box has no stick with an export"
                                          : "the stick has several exports: name one of";
  for (const api::StickExportRow& each : stick.exports) why += ' ' + each.name;
  return to_failure(why, Exit::Attention);
}

Result<void> import_from_stick(const Call& call) {
  const auto name = ADIT_TRY(name_on_stick(call));
  const codec::Value wanted{codec::Value::Object{{"name", {name}}}};
  ADIT_TRY(ask_stick(call.adit, "/adit/spare/from-stick", codec::write_json(wanted)));
  return {};
}

Result<void> import_file(const Call& call) {
  auto file = ADIT_TRY(read_export(call.options.argument()));
  ADIT_TRY(post(call.adit, {.target = "/adit/spare/take",
                            .check = kSeeSpare,
                            .body = std::move(file),
                            .within = kFileWithin,
                            .content_type = "application/octet-stream"}));
  return {};
}

}  // namespace

Result<Outcome> show_spare(const Call& call) {
  return show<SpareView>(call, kSpare, text_of, [](const SpareView& view) {
    return !view.standby && !view.asks_code && !view.taken_in && !view.takes_over;
  });
}

Result<Outcome> export_spare(const Call& call) {
  if (call.options.stick) return write_to_stick(call);
  const auto view = ADIT_TRY(put_on_standby(call));
  const auto file = ADIT_TRY(get(call.adit, "/adit/spare/export", kFileWithin));
  if (const auto kept = host::write_file(call.options.argument(), file, host::kOursAlone); !kept)
    return to_failure("the box is on standby, but its export could not be written: " + kept.error());
  return on_standby(call, view, "in " + call.options.argument());
}

Result<Outcome> take_spare(const Call& call) {
  const auto& [adit, options, console] = call;
  if (options.code.empty()) return to_failure("the code of the export is missing: give --code");
  ADIT_TRY(options.stick ? import_from_stick(call) : import_file(call));
  const codec::Value code{codec::Value::Object{{"code", {options.code}}}};
  const auto opened = ADIT_TRY(
      post(adit, {.target = "/adit/spare/open", .check = kSeeSpare, .body = codec::write_json(code)}));
  const auto told = ADIT_TRY(fetch<SpareView>(adit, kSpare));
  if (!told.row.taken_in) return to_failure("the box no longer has the export: see adit spare");
  if (!options.json) console.print(text_of(*told.row.taken_in));
  ADIT_TRY(confirm(options, console,
                   "If that box is still plugged in, or no longer on standby, reports may be sent twice.",
                   "Is that box unplugged, and should this box take over?"));
  ADIT_TRY(
      post(adit, {.target = "/adit/spare/take-over", .check = kSeeSpare, .body = R"({"unplugged": true})"}));
  return print_result(call, opened, "this box is taking over\n");
}

Result<Outcome> resume_service(const Call& call) {
  ADIT_TRY(confirm(call.options, call.console,
                   "If a spare has taken over from this box, reports may be sent twice.",
                   "End the standby?"));
  return act(call, {.target = "/adit/spare/resume", .check = kSeeSpare}, "this box is in service\n");
}

}  // namespace adit::cli
