#include "network/check.hpp"

#include <algorithm>
#include <array>

#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "settings/settings.hpp"
#include "settings/subnet.hpp"
#include "settings/written.hpp"

namespace adit::cli {
namespace {

using codec::Value;
using settings::Settings;

std::string listening_place(const std::string& interface) {
  return interface.empty() ? "on any interface" : "on " + interface + " only";
}

std::string asked_of(const settings::Team& team) {
  if (team.require_token) return "";
  return ", without a token" + (team.origins.empty() ? "" : ", also for pages of " + team.origins);
}

std::string lines_of(const settings::Panel& panel) {
  return icd::join_words(
      std::array{panel.health, panel.scoring, panel.mapping, panel.attention, panel.button});
}

/// The team's subnets, as far as settings and interfaces show.
std::vector<settings::Subnet> team_subnets(const settings::Team& team,
                                           const std::vector<host::Interface>& interfaces) {
  std::vector<settings::Subnet> subnets;
  for (const host::Interface& each : interfaces) {
    if (team.interface != each.name) continue;
    for (const std::string& address : each.addresses) {
      if (const auto subnet = settings::parse_subnet(address)) subnets.push_back(*subnet);
    }
  }
  for (const settings::Address& listen : team.listen) {
    const auto address = settings::ipv4_of(listen.address);
    const bool is_known = std::ranges::any_of(
        subnets, [&](const settings::Subnet& each) { return address && each.contains(*address); });
    if (address && *address != 0 && !is_known) subnets.push_back({*address, 32});
  }
  return subnets;
}

/// Warnings about settings that aditd accepts.
std::vector<std::string> warnings_of(const Options& options, const Settings& settings) {
  std::vector<std::string> sentences;
  const auto secrets =
      host::read_secrets(options.secrets, options.saved_secrets, settings::token_names(settings));
  const std::string unread = secrets ? secrets->unread : secrets.error();
  if (!unread.empty()) sentences.push_back("cannot check the tokens: " + unread);
  if (secrets) {
    for (const auto& [name, sentence] : secrets->token_warnings()) sentences.push_back(sentence);
  }
  const auto interfaces = host::interfaces();
  if (!interfaces) sentences.push_back("cannot check the team's network: " + interfaces.error());
  network::Circumstances around;
  around.command_post = settings.command_post;
  around.courses = settings.courses;
  for (const settings::Subnet& team :
       team_subnets(settings.team, interfaces.value_or(std::vector<host::Interface>()))) {
    const std::string what = network::overlap_of({.team = team}, around);
    if (what.empty()) continue;
    sentences.push_back(icd::sentence("the team's network ", settings::to_text(team), " overlaps ", what,
                                      " on the Command Post's side (ICD 3): ",
                                      settings.network.allow_overlap
                                          ? "allowed, but a robot cannot reach both"
                                          : "choose another subnet for the team"));
  }
  return sentences;
}

/// Shows the settings, so that a user sees whether a valid file is the right one.
std::string summary(const std::string& file, const Settings& settings,
                    const std::vector<std::string>& warnings, bool colour) {
  const settings::CommandPost& post = settings.command_post;
  Table table({{}, {}, {}});
  table.add({{"scoring", Tone::Strong}, {to_text(post.scoring)}, {listening_place(post.interface)}});
  table.add({{"mapping", Tone::Strong}, {to_text(post.mapping)}, {listening_place(post.interface)}});
  for (const settings::Address& listen : settings.team.listen) {
    table.add({{"team", Tone::Strong},
               {to_text(listen)},
               {listening_place(settings.team.interface) + asked_of(settings.team)}});
  }
  table.add({{"link", Tone::Strong}, {decimal(post.budget_mbit, 3) + " Mbit/s"}, {}});
  const settings::Panel& panel = settings.panel;
  const std::string chip = panel.chip.empty() ? "any chip" : panel.chip;
  table.add({{"panel", Tone::Strong}, {panel.is_simulated() ? "simulated" : chip}, {lines_of(panel)}});
  std::string text =
      host::escape(file) + ": " + paint("correct", Tone::Good, colour) + '\n' + table.to_text(colour);
  for (const std::string& warning : warnings)
    text += "  " + paint("warning", Tone::Warning, colour) + ": " + host::escape(warning) + '\n';
  return text;
}

std::string sentences(const std::string& file, const std::vector<settings::Error>& errors, bool colour) {
  const std::string number = std::to_string(errors.size()) + (errors.size() == 1 ? " error" : " errors");
  std::string text = host::escape(file) + ": " + paint(number, Tone::Bad, colour) + '\n';
  for (const settings::Error& error : errors) {
    const std::string path = host::escape(error.path);
    text += "  " + (error.at.empty() ? "" : error.at + ": ") +
            (path.empty() ? "" : paint(path, Tone::Strong, colour) + ": ") + host::escape(error.what) + '\n';
  }
  return text;
}

std::string errors_to_json(const std::vector<settings::Error>& errors,
                           const std::vector<std::string>& warnings) {
  Value::Array list, told;
  for (const std::string& warning : warnings) told.push_back({warning});
  for (const settings::Error& error : errors) {
    list.push_back({Value::Object{{"path", {error.path}}, {"what", {error.what}}, {"at", {error.at}}}});
  }
  return codec::write_json(
             {Value::Object{{"good", {errors.empty()}}, {"errors", {list}}, {"warnings", {told}}}}) +
         '\n';
}

}  // namespace

Result<Outcome> check(const Options& options, const Console& console) {
  const std::string file = options.argument().empty() ? options.settings : options.argument();
  const auto text = host::read_file(file);
  if (!text) return to_failure(text.error());
  const auto settings = settings::parse(*text);
  auto errors = settings ? std::vector<settings::Error>() : settings.error();
  settings::find_places(*text, errors);
  const auto warnings = settings ? warnings_of(options, *settings) : std::vector<std::string>();
  const Exit exit = settings ? Exit::Fine : Exit::Attention;
  if (options.json) return Outcome{exit, errors_to_json(errors, warnings), ""};
  return Outcome{
      exit,
      settings ? summary(file, *settings, warnings, console.colour) : sentences(file, errors, console.colour),
      ""};
}

}  // namespace adit::cli
