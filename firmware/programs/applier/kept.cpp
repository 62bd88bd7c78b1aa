#include "applier/kept.hpp"

#include "host/log.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "update/messages.hpp"

namespace adit::applier {
namespace {

/// `what`: for the error, as in "cannot read ...".
template <class Message>
std::expected<Message, std::string> load(const std::string& path, std::string_view what) {
  auto kept = host::read_row<Message>(path);
  if (kept) return (*std::move(kept)).value_or(Message{});
  return std::unexpected(icd::sentence("cannot read ", what, ": ", kept.error()));
}

bool save(const std::string& path, const std::string& text, std::string_view what) {
  return host::log_failure(host::Level::Error, "cannot store " + std::string(what),
                           host::write_file(path, text, host::kForAll));
}

constexpr std::string_view kLast = "the outcome of the last update", kGood = "the slot that was good last";

}  // namespace

std::expected<update::LastUpdate, std::string> load_last_update(const std::string& folder) {
  return load<update::LastUpdate>(folder + '/' + update::kLastUpdateFile, kLast);
}

bool save(const std::string& folder, const update::LastUpdate& last_update) {
  return save(folder + '/' + update::kLastUpdateFile, codec::write_file(last_update), kLast);
}

std::expected<update::Proven, std::string> load_proven(const std::string& folder) {
  return load<update::Proven>(folder + '/' + update::kProvenFile, kGood);
}

bool save(const std::string& folder, const update::Proven& proven) {
  return save(folder + '/' + update::kProvenFile, codec::write_file(proven), kGood);
}

}  // namespace adit::applier
