#include "applier/kept.hpp"

#include <cerrno>

#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "update/messages.hpp"

namespace adit::applier {
namespace {

/// `what`: for the log, as "... is not known" and "... cannot be kept".
template <class Message>
Message load(const std::string& path, std::string_view what) {
  const auto text = host::slurp(path);
  if (!text && text.error() == ENOENT) return {};
  auto kept = text ? update::read<Message>(text->text) : std::unexpected(host::trouble(path, text.error()));
  if (kept) return *std::move(kept);
  host::log(host::Level::Error, "cannot read " + std::string(what), {{"why", kept.error()}});
  return {};
}

bool save(const std::string& path, const std::string& text, std::string_view what) {
  const auto written = host::write_file(path, text, host::kForAll);
  if (!written)
    host::log(host::Level::Error, "cannot store " + std::string(what), {{"why", written.error()}});
  return written.has_value();
}

constexpr std::string_view kLast = "the outcome of the last update", kGood = "the slot that was good last";

std::string last_update_in(const std::string& folder) {
  return folder + '/' + update::kLastUpdateFile;
}

std::string proven_in(const std::string& folder) {
  return folder + '/' + update::kProvenFile;
}

}  // namespace

update::LastUpdate load_last_update(const std::string& folder) {
  return load<update::LastUpdate>(last_update_in(folder), kLast);
}

bool save(const std::string& folder, const update::LastUpdate& last_update) {
  return save(last_update_in(folder), update::write(last_update), kLast);
}

update::Proven load_proven(const std::string& folder) {
  return load<update::Proven>(proven_in(folder), kGood);
}

bool save(const std::string& folder, const update::Proven& proven) {
  return save(proven_in(folder), update::write(proven), kGood);
}

}  // namespace adit::applier
