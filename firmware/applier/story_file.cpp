#include "applier/story_file.hpp"

#include <cerrno>

#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "update/messages.hpp"

namespace adit::applier {

update::Story load_story(const std::string& folder) {
  const std::string path = folder + '/' + update::kStoryFile;
  const auto text = host::slurp(path);
  if (!text && text.error() == ENOENT) return {};
  const auto story =
      text ? update::read_story(text->text) : std::unexpected(host::trouble(path, text.error()));
  if (story) return *story;
  host::log(host::Level::Error, "what became of the last update is not known", {{"why", story.error()}});
  return {};
}

bool save_story(const std::string& folder, const update::Story& story) {
  const auto written =
      host::write_file(folder + '/' + update::kStoryFile, update::write(story), host::kForAll);
  if (!written)
    host::log(host::Level::Error, "what became of the update cannot be kept", {{"why", written.error()}});
  return written.has_value();
}

}  // namespace adit::applier
