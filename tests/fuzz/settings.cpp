// The settings file, which is also the body that the page saves, and what a later release saved.
#include "settings/settings.hpp"

#include "settings/written.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

std::expected<settings::Settings, std::string> read_settings(std::string_view text) {
  auto read = settings::parse(text);
  if (!read) return std::unexpected(settings::sentence_of(read.error()));
  return *std::move(read);
}

}  // namespace

void try_settings(Input text) {
  settles(text, read_settings, settings::file_of);
  const auto settings = settings::parse(text);
  const auto saved = settings::parse_saved(text);
  require(saved.has_value() || !saved.error().empty());
  if (!settings) return;
  require(saved && saved->passed_over.empty());
  require(settings::tag_of(saved->settings) == settings::tag_of(*settings));
  require(settings::changes(*settings, saved->settings).empty());
  (void)settings::effective_settings(*settings);
}

}  // namespace adit::fuzz
