#include "cli/check.hpp"

#include "cli/table.hpp"
#include "cli/where.hpp"
#include "cli/words.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "settings/settings.hpp"

namespace adit::cli {
namespace {

using codec::Value;
using settings::Settings;

std::string by(const std::string& interface) {
  return interface.empty() ? "by any interface" : "by " + interface + " alone";
}

std::string asked_of(const settings::Team& team) {
  if (team.require_token) return "";
  return ", no token asked for" +
         (team.origins.empty() ? "" : ", not of pages of " + team.origins + " either");
}

std::string lines_of(const settings::Panel& panel) {
  std::string lines;
  for (const std::string& line :
       {panel.health, panel.scoring, panel.mapping, panel.attention, panel.button}) {
    if (!line.empty()) lines.append(lines.empty() ? "" : ", ").append(line);
  }
  return lines;
}

/// What the settings come to: that the file is right does not yet say that it is the right file.
std::string summary(const std::string& file, const Settings& settings, bool colour) {
  const settings::CommandPost& post = settings.command_post;
  Table table({{}, {}, {}});
  table.add({{"scoring", Tone::Strong}, {written(post.scoring)}, {by(post.interface)}});
  table.add({{"mapping", Tone::Strong}, {written(post.mapping)}, {by(post.interface)}});
  for (const settings::Address& listen : settings.team.listen) {
    table.add(
        {{"team", Tone::Strong}, {written(listen)}, {by(settings.team.interface) + asked_of(settings.team)}});
  }
  table.add({{"link", Tone::Strong}, {decimal(post.budget_mbit, 3) + " Mbit/s"}, {}});
  const settings::Panel& panel = settings.panel;
  const std::string chip = panel.chip.empty() ? "any chip" : panel.chip;
  table.add({{"panel", Tone::Strong}, {panel.is_simulated() ? "simulated" : chip}, {lines_of(panel)}});
  return host::escaped(file) + ": " + painted("good", Tone::Good, colour) + '\n' + table.written(colour);
}

std::string sentences(const std::string& file, const std::vector<settings::Error>& errors, bool colour) {
  const std::string number = std::to_string(errors.size()) + (errors.size() == 1 ? " error" : " errors");
  std::string text = host::escaped(file) + ": " + painted(number, Tone::Bad, colour) + '\n';
  for (const settings::Error& error : errors) {
    const std::string path = host::escaped(error.path);
    text += "  " + (path.empty() ? "" : painted(path, Tone::Strong, colour) + ": ") +
            host::escaped(error.what) + '\n';
  }
  return text;
}

std::string as_json(const std::vector<settings::Error>& errors) {
  Value::Array list;
  for (const settings::Error& error : errors) {
    list.push_back({Value::Object{{"path", {error.path}}, {"what", {error.what}}}});
  }
  return codec::write_json({Value::Object{{"good", {errors.empty()}}, {"errors", {list}}}}) + '\n';
}

}  // namespace

Outcome check(const Options& options, bool colour) {
  const auto text = host::read_file(options.settings);
  if (!text) return {Exit::Unable, "", "adit: " + text.error() + '\n'};
  const auto settings = settings::parse(*text);
  const auto errors = settings ? std::vector<settings::Error>() : settings.error();
  const Exit exit = settings ? Exit::Fine : Exit::Attention;
  if (options.json) return {exit, as_json(errors), ""};
  if (settings) return {exit, summary(options.settings, *settings, colour), ""};
  return {exit, sentences(options.settings, errors, colour), ""};
}

}  // namespace adit::cli
