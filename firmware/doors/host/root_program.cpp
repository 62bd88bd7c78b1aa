#include "host/root_program.hpp"

#include <cerrno>
#include <utility>

#include "codec/nonce.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/random.hpp"

namespace adit::host {

std::string draw_nonce() {
  return random_digits<codec::kNonceDigits / 2>();
}

std::expected<std::optional<std::string>, std::string> read_optional_file(const std::string& path) {
  auto file = slurp(path);
  if (file) return std::move(file->text);
  if (file.error() == ENOENT) return std::nullopt;
  return std::unexpected(path_error(path, file.error()));
}

void withdraw_request(const std::string& path, const std::string& program) {
  log(Level::Error, program + " did not read a request", {{"file", path}});
  log_failure(Level::Error, "cannot withdraw a request", remove_file(path));
}

void StatusFile::log_unreadable(const std::string& why) {
  log(Level::Error, "cannot read the status", {{"why", why}});
}

std::expected<bool, std::string> StatusFile::write_text(std::string text) {
  if (text == told_) return false;
  if (auto written = write_file(path_, text, kForAll); !written) {
    log(Level::Error, "cannot write the status", {{"why", written.error()}});
    return std::unexpected(std::move(written.error()));
  }
  told_ = std::move(text);
  return true;
}

std::expected<std::optional<UntrustedFolder>, std::string> open_requests(const std::string& directory) {
  auto folder = UntrustedFolder::open(directory);
  if (folder) return *std::move(folder);
  if (can_exist(directory)) return std::unexpected(std::move(folder.error()));
  log(Level::Info, "no requests: their directory does not exist", {{"directory", directory}});
  return std::nullopt;
}

void log_rejected_request(const char* file, const std::string& why) {
  log(Level::Warning, "request rejected", {{"file", file}, {"why", why}});
}

}  // namespace adit::host
