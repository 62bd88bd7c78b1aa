#include "applier/status_file.hpp"

#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::applier {

std::expected<bool, std::string> StatusFile::tell(std::string text) {
  if (text == told_) return false;
  if (auto written = host::write_file(path_, text, host::kForAll); !written) {
    host::log(host::Level::Error, "cannot write the status", {{"why", written.error()}});
    return std::unexpected(std::move(written.error()));
  }
  told_ = std::move(text);
  return true;
}

}  // namespace adit::applier
