#include "cli/contexts.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "api/box.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/suggestion.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

using codec::member;
using codec::Member;
using codec::Value;

constexpr Member kContext[] = {
    member<&Context::name>("name"),
    member<&Context::at>("at"),
    member<&Context::token>("token"),
};
constexpr Member kContexts[] = {
    member<&Contexts::current>("current"),
    member<&Contexts::all>("contexts"),
};

std::vector<std::string_view> names_in(const Contexts& contexts) {
  std::vector<std::string_view> names;
  names.reserve(contexts.all.size());
  for (const Context& each : contexts.all) names.push_back(each.name);
  return names;
}

}  // namespace

constexpr codec::Row Context::kRow = codec::complete<Context>({"", kContext});
constexpr codec::Row Contexts::kRow = codec::complete<Contexts>({"", kContexts});

const Context* Contexts::find(const std::string& name) const {
  const auto found = std::ranges::find(all, name, &Context::name);
  return found == all.end() ? nullptr : &*found;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

std::string contexts_file() {
  const std::string config = variable("XDG_CONFIG_HOME"), home = variable("HOME");
  if (config.starts_with('/')) return config + "/adit/contexts.json";
  return home.empty() ? "" : home + "/.config/adit/contexts.json";
}

std::expected<Contexts, std::string> load_contexts(const std::string& file) {
  if (file.empty() || !host::can_exist(file)) return Contexts{};
  const auto text = ADIT_TRY(host::read_file(file));
  auto contexts = codec::read_file<Contexts>(text);
  if (!contexts) return std::unexpected(file + ": " + contexts.error());
  return contexts;
}

std::expected<void, std::string> save(const Contexts& contexts, const std::string& file) {
  constexpr int kOwnersFile = 0600, kOwnersFolder = 0700;
  if (file.empty()) return std::unexpected("there is no directory for it: set HOME");
  const std::string folder = file.substr(0, file.rfind('/'));
  for (const std::string& each : {folder.substr(0, folder.rfind('/')), folder}) {
    if (::mkdir(each.c_str(), kOwnersFolder) != 0 && errno != EEXIST)
      return std::unexpected(host::path_error(each, errno));
  }
  return host::write_file(file, codec::write_file(contexts), kOwnersFile);
}

namespace {

Result<Contexts> load() {
  auto contexts = load_contexts(contexts_file());
  if (!contexts) return to_failure(contexts.error());
  return *std::move(contexts);
}

Result<const Context*> find_context(const Contexts& contexts, const std::string& name) {
  if (const Context* const found = contexts.find(name)) return found;
  const std::string advice =
      contexts.all.empty() ? "; adit login ADDRESS makes one" : icd::did_you_mean(name, names_in(contexts));
  return to_failure("there is no context " + name + advice, Exit::Attention);
}

/// Without the port that Adit usually has.
std::string name_for(const std::string& at) {
  const auto address = parse_location(at);
  if (!address) return at;
  const std::string whole = to_text(*address), usual = ":8000";
  return whole.ends_with(usual) ? whole.substr(0, whole.size() - usual.size()) : whole;
}

std::string json_of(const Contexts& contexts) {
  Value::Array list;
  for (const Context& each : contexts.all)
    list.push_back({Value::Object{
        {"name", {each.name}}, {"at", {each.at}}, {"current", {each.name == contexts.current}}}});
  return codec::write_json({list}) + '\n';
}

/// Saves them. The output says `done`, or with --json lists all.
Result<Outcome> save_contexts(const Contexts& contexts, const Options& options, std::string done) {
  if (const auto written = save(contexts, contexts_file()); !written)
    return to_failure("cannot save the context: " + written.error());
  return Outcome{Exit::Fine, options.json ? json_of(contexts) : std::move(done), ""};
}

}  // namespace

Result<Outcome> log_in(const Options& options, const Console& console) {
  Contexts contexts = ADIT_TRY(load());
  const Context* const known = contexts.find(options.argument());
  const std::string at = known == nullptr ? options.argument() : known->at;
  const std::string usual_name = known == nullptr ? name_for(at) : known->name;
  Options asked = options;
  asked.at = at;
  if (asked.token_file.empty() && variable("ADIT_TOKEN_FILE").empty() && variable("ADIT_TOKEN").empty())
    asked.token_file = "-";
  const Adit adit = ADIT_TRY(adit_of(asked, console));
  const auto about = ADIT_TRY(fetch<api::About>(adit, "/adit/about")).row;
  ADIT_TRY(get(adit, "/adit/sessions"));  // only an operator may
  const std::string name = options.name.empty() ? usual_name : options.name;
  std::erase_if(contexts.all, [&name](const Context& each) { return each.name == name; });
  contexts.all.push_back({name, at, adit.token.token.reveal()});
  contexts.current = name;
  return save_contexts(contexts, options,
                       line("logged in to Adit ", about.version, " at ", to_text(adit.address),
                            "; later commands ask it (context ", name, ")"));
}

Result<Outcome> show_contexts(const Options& options, const Console& console) {
  const Contexts contexts = ADIT_TRY(load());
  if (options.json) return Outcome{Exit::Fine, json_of(contexts), ""};
  if (contexts.all.empty()) return Outcome{Exit::Fine, "no context: see adit help login\n", ""};
  Table table({{}, {}, {}});
  for (const Context& each : contexts.all)
    table.add({{each.name == contexts.current ? "*" : "", Tone::Good}, {each.name, Tone::Strong}, {each.at}});
  return Outcome{Exit::Fine, table.to_text(console.colour), ""};
}

Result<Outcome> use_context(const Options& options, const Console& /*console*/) {
  Contexts contexts = ADIT_TRY(load());
  const Context* const context = ADIT_TRY(find_context(contexts, options.argument()));
  contexts.current = context->name;
  return save_contexts(contexts, options, line("commands ask the Adit at ", context->at));
}

Result<Outcome> remove_context(const Options& options, const Console& /*console*/) {
  Contexts contexts = ADIT_TRY(load());
  const std::string name = options.argument();
  if (const auto found = find_context(contexts, name); !found) return std::unexpected(found.error());
  std::erase_if(contexts.all, [&name](const Context& each) { return each.name == name; });
  if (contexts.current == name) contexts.current.clear();
  return save_contexts(contexts, options, line("context ", name, " and its token are removed"));
}

}  // namespace adit::cli
