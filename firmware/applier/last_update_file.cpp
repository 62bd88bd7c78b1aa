#include "applier/last_update_file.hpp"

#include <cerrno>

#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "update/messages.hpp"

namespace adit::applier {

update::LastUpdate load_last_update(const std::string& folder) {
  const std::string path = folder + '/' + update::kLastUpdateFile;
  const auto text = host::slurp(path);
  if (!text && text.error() == ENOENT) return {};
  const auto last_update = text ? update::read<update::LastUpdate>(text->text)
                                : std::unexpected(host::trouble(path, text.error()));
  if (last_update) return *last_update;
  host::log(host::Level::Error, "what became of the last update is not known",
            {{"why", last_update.error()}});
  return {};
}

bool save_last_update(const std::string& folder, const update::LastUpdate& last_update) {
  const auto written =
      host::write_file(folder + '/' + update::kLastUpdateFile, update::write(last_update), host::kForAll);
  if (!written)
    host::log(host::Level::Error, "what became of the update cannot be kept", {{"why", written.error()}});
  return written.has_value();
}

}  // namespace adit::applier
