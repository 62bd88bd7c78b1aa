#include "cli/spare.hpp"

#include <chrono>
#include <fstream>
#include <iterator>

#include "api/reports_csv.hpp"
#include "api/spare.hpp"
#include "cli/ask.hpp"
#include "cli/doubt.hpp"
#include "cli/http_client.hpp"
#include "cli/reading.hpp"
#include "cli/where.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "spare/sealed.hpp"

namespace adit::cli {
namespace {

using api::SpareView;

/// Until what is under way is answered, and the box is up again.
constexpr std::chrono::seconds kStandby{60}, kFile{60};
/// For a slow stick, and where it is another's turn before.
constexpr std::chrono::seconds kStick{330};
constexpr std::chrono::milliseconds kAskEvery{300};

std::string text_of(const api::ExportRow& row) {
  std::string out =
      host::escaped(icd::sentence("From the box at ", row.name, " (Adit ", row.version,
                                  "), on standby since ", api::iso_time(row.at), " by its clock")) +
      '\n';
  out += host::escaped(icd::sentence("  ", row.reports, " reports, ", row.open,
                                     " of them unfinished, for the Command Post at ", row.post)) +
         '\n';
  if (row.run)
    out += icd::sentence("  score ", row.run->score, ", ", row.run->remaining_reports, " reports left\n");
  for (const std::string& path : row.left_out)
    out += icd::sentence("  left out, because this version does not know it: ", host::escaped(path), "\n");
  return out;
}

std::string text_of(const api::StickRow& stick, bool standby) {
  std::string out;
  if (!stick.doing.empty()) out += icd::sentence("The stick: ", host::escaped(stick.doing), "\n");
  if (!stick.refusal.empty()) out += icd::sentence("The stick: ", host::escaped(stick.refusal), "\n");
  if (standby && !stick.written.empty())
    out += icd::sentence(
        "Its export is on the stick, which you may now unplug: ", host::escaped(stick.written), "\n");
  for (const api::StickExportRow& each : stick.exports) {
    if (!standby || each.name != stick.written)
      out += icd::sentence("On the stick: ", host::escaped(each.name), "\n");
  }
  return out;
}

std::string text_of(const SpareView& view) {
  std::string out;
  if (view.standby) out += icd::sentence("This box is on standby: ", host::escaped(view.why), "\n");
  if (!view.code.empty()) out += icd::sentence("Code of its export: ", view.code, "\n");
  if (view.takes_over) out += "This box is taking over\n";
  if (view.asks_code) out += "An export was imported, and needs its code\n";
  if (view.taken_in) out += text_of(*view.taken_in);
  if (view.stick) out += text_of(*view.stick, view.standby);
  return out.empty() ? "This box is in service\n" : out;
}

Outcome shown(const Options& options, const std::string& json, const SpareView& view) {
  const bool is_plain = !view.standby && !view.asks_code && !view.taken_in && !view.takes_over;
  return {is_plain ? Exit::Fine : Exit::Attention, options.json ? json + '\n' : text_of(view), ""};
}

std::expected<SpareView, Failure> spare_of(const Adit& adit) {
  const auto json = get(adit, "/adit/spare");
  if (!json) return std::unexpected(Failure{Exit::Unable, json.error()});
  auto view = read<SpareView>(adit, *json);
  if (!view) return std::unexpected(Failure{Exit::Unable, view.error()});
  return *std::move(view);
}

/// Each answer within that it is there or not, while the box ends what is under way and begins again.
std::expected<SpareView, Failure> wait_until(const Adit& adit, bool (*is_so)(const SpareView&),
                                             std::chrono::seconds within) {
  std::expected<SpareView, Failure> view;
  const bool is_over = wait_for(within, kAskEvery, [&] { return (view = spare_of(adit)) && is_so(*view); });
  if (is_over || !view) return view;
  return std::unexpected(Failure{Exit::Unable, "the box has not finished: see adit spare"});
}

std::expected<SpareView, Failure> put_on_standby(const Adit& adit, const Options& options,
                                                 const Console& console) {
  if (auto why = doubt(options, console,
                       "On standby, this box accepts and sends no messages. Queued reports are part of the "
                       "export; queued maps, states and markers stay here.",
                       "Put it on standby?"))
    return std::unexpected(*std::move(why));
  if (auto done = post(adit, "/adit/spare/standby", "", "adit spare"); !done)
    return std::unexpected(std::move(done.error()));
  return wait_until(adit, [](const SpareView& seen) { return seen.standby && !seen.code.empty(); }, kStandby);
}

/// What became of what the stick was asked for.
std::expected<SpareView, Failure> ask_stick(const Adit& adit, const char* target, const std::string& body) {
  if (auto done = post(adit, target, body, "adit spare"); !done)
    return std::unexpected(std::move(done.error()));
  auto view = wait_until(
      adit, [](const SpareView& seen) { return !seen.stick || seen.stick->doing.empty(); }, kStick);
  if (!view) return view;
  if (!view->stick) return std::unexpected(Failure{Exit::Unable, "adit-spare is not running"});
  if (view->stick->refusal.empty()) return view;
  return std::unexpected(Failure{Exit::Attention, host::escaped(view->stick->refusal)});
}

/// As it is before anything is asked.
std::expected<api::StickRow, Failure> stick_of(const Adit& adit) {
  auto view = spare_of(adit);
  if (!view) return std::unexpected(std::move(view.error()));
  if (view->stick) return *std::move(view->stick);
  return std::unexpected(Failure{Exit::Unable, "this box cannot use a stick: name a file"});
}

Outcome write_to_stick(const Adit& adit, const Options& options, const Console& console) {
  const auto stick = stick_of(adit);
  if (!stick) return unable(stick.error());
  if (!stick->hindrance.empty())
    return unable(
        Failure{Exit::Attention, "the box was not put on standby: " + host::escaped(stick->hindrance)});
  const auto is_done = put_on_standby(adit, options, console);
  if (!is_done) return unable(is_done.error());
  const auto view = ask_stick(adit, "/adit/spare/to-stick", "");
  if (!view)
    return unable(Failure{view.error().exit, "the box is on standby, but its export is not on the stick: " +
                                                 view.error().sentence});
  if (options.json) return {Exit::Fine, codec::to_json(*view) + '\n', ""};
  return {Exit::Fine,
          icd::sentence("This box is on standby. Its export is on the stick, which you may now unplug: ",
                        host::escaped(view->stick->written), "\nCode of its export: ", view->code,
                        "\nUnplug this box before the spare takes over.\n"),
          ""};
}

Outcome write_export(const Adit& adit, const Options& options, const Console& console) {
  if (options.stick) return write_to_stick(adit, options, console);
  const auto view = put_on_standby(adit, options, console);
  if (!view) return unable(view.error());
  const auto file = find(adit, "/adit/spare/export", kFile);
  if (!file) return unable(file.error());
  if (const auto kept = host::write_file(options.file, *file, host::kOursAlone); !kept)
    return unable("the box is on standby, but its export could not be written: " + kept.error());
  if (options.json) return {Exit::Fine, codec::to_json(*view) + '\n', ""};
  return {
      Exit::Fine,
      icd::sentence("This box is on standby. Its export is in ", host::escaped(options.file),
                    "\nCode of its export: ", view->code, "\nUnplug this box before the spare takes over.\n"),
      ""};
}

std::expected<std::string, std::string> read_export(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(spare::kLargestExport + 1, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.is_open() || file.bad()) return std::unexpected(path + ": cannot be read");
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (bytes.size() > spare::kLargestExport) return std::unexpected(path + ": too large for an export");
  if (std::string why = spare::not_an_export(std::string_view(bytes).substr(0, spare::kExportHead));
      !why.empty())
    return std::unexpected(path + ": " + why);
  return bytes;
}

std::optional<Failure> send(const Adit& adit, std::string file) {
  const auto reply = http_ask(adit.address,
                              {.method = HttpRequest::Method::Post,
                               .target = "/adit/spare/take",
                               .token = adit.token.token,
                               .body = std::move(file),
                               .content_type = "application/octet-stream"},
                              kFile);
  if (!reply) return Failure{Exit::Unable, reply.error().sentence};
  if (reply->status == 200) return std::nullopt;
  return failure(adit, *reply);
}

/// Which export on the stick is meant.
std::expected<std::string, Failure> name_on_stick(const Adit& adit, const Options& options) {
  if (!options.file.empty()) return options.file;
  const auto stick = stick_of(adit);
  if (!stick) return std::unexpected(stick.error());
  if (stick->exports.size() == 1) return stick->exports.front().name;
  std::string why = stick->exports.empty() ? "the box has no stick with an export"
                                           : "the stick has several exports: name one of";
  for (const api::StickExportRow& each : stick->exports) why += ' ' + host::escaped(each.name);
  return std::unexpected(Failure{Exit::Attention, std::move(why)});
}

/// The box takes in what is in the file, or on its stick.
std::optional<Failure> take_in(const Adit& adit, const Options& options) {
  if (!options.stick) {
    auto file = read_export(options.file);
    if (!file) return Failure{Exit::Unable, std::move(file.error())};
    return send(adit, *std::move(file));
  }
  const auto name = name_on_stick(adit, options);
  if (!name) return name.error();
  const codec::Value wanted{codec::Value::Object{{"name", {*name}}}};
  const auto view = ask_stick(adit, "/adit/spare/from-stick", codec::write_json(wanted));
  return view ? std::nullopt : std::optional(view.error());
}

Outcome take(const Adit& adit, const Options& options, const Console& console) {
  if (options.code.empty()) return unable("the code of the export is missing: give --code");
  if (const auto failure = take_in(adit, options)) return unable(*failure);
  const codec::Value code{codec::Value::Object{{"code", {options.code}}}};
  const auto opened = post(adit, "/adit/spare/open", codec::write_json(code), "adit spare");
  if (!opened) return unable(opened.error());
  const auto view = spare_of(adit);
  if (!view) return unable(view.error());
  if (!view->taken_in) return unable("the box no longer has the export: see adit spare");
  const std::string what = text_of(*view->taken_in);
  if (!options.json) console.print(what);
  if (const auto why =
          doubt(options, console,
                "If that box is still plugged in, or no longer on standby, reports may be sent twice.",
                "Is that box unplugged, and should this box take over?"))
    return unable(*why);
  if (const auto done = post(adit, "/adit/spare/take-over", R"({"unplugged": true})", "adit spare"); !done)
    return unable(done.error());
  return {Exit::Fine, options.json ? *opened + '\n' : "this box is taking over\n", ""};
}

Outcome resume(const Adit& adit, const Options& options, const Console& console) {
  if (const auto why =
          doubt(options, console, "If a spare has taken over from this box, reports may be sent twice.",
                "End the standby?"))
    return unable(*why);
  const auto done = post(adit, "/adit/spare/resume", "", "adit spare");
  if (!done) return unable(done.error());
  return {Exit::Fine, options.json ? *done + '\n' : "this box is in service\n", ""};
}

}  // namespace

Outcome spare(const Options& options, const Console& console) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (options.verb == Verb::Export) return write_export(*adit, options, console);
  if (options.verb == Verb::Take) return take(*adit, options, console);
  if (options.verb == Verb::Resume) return resume(*adit, options, console);
  const auto json = get(*adit, "/adit/spare");
  if (!json) return unable(json.error());
  const auto view = read<SpareView>(*adit, *json);
  return view ? shown(options, *json, *view) : unable(view.error());
}

}  // namespace adit::cli
