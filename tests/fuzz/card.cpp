// What somebody put on the boot partition: settings, addresses and a token, one behind the other with a line
// of "--" between.
#include <algorithm>

#include "applier/import.hpp"
#include "folder.hpp"
#include "settings/written.hpp"

namespace adit::fuzz {

void try_card(Input text) {
  static const Folder folder;
  folder.clear();
  for (const char* name : {"settings.json", "network.json", "secrets/scoring.token"}) {
    const auto end = text.find("\n--\n");
    if (!text.empty()) folder.put(name, text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end == Input::npos ? end : end + 4));
  }
  const auto card = host::UntrustedFolder::open(folder.path());
  require(card.has_value());
  const applier::CardResult found = applier::read_card(*card, settings::Settings{});
  require(found.left_alone.empty());
  for (const std::string& error : found.errors) {
    require(error.starts_with("adit/"));
    require(std::ranges::all_of(error, [](char c) { return c >= ' ' && c <= '~'; }));
  }
  if (found.brought.settings)
    require(settings::parse(settings::file_of(*found.brought.settings)).has_value());
}

}  // namespace adit::fuzz
