#include "admin/factory_reset.hpp"

#include <filesystem>
#include <utility>

#include "access/certificate.hpp"
#include "admin/accounts.hpp"
#include "admin/kept_file.hpp"
#include "admin/takeover.hpp"
#include "forward/clocks.hpp"
#include "host/log.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "network/messages.hpp"

namespace adit::admin {

FactoryReset::FactoryReset(Store& store, std::string state_folder, std::string runtime_folder)
    : store_(store), state_(std::move(state_folder)), runtime_(std::move(runtime_folder)) {}

std::expected<void, std::string> FactoryReset::begin() {
  return host::write_file(marker_path(), "", host::kOursAlone);
}

std::expected<bool, std::string> FactoryReset::finish() {
  std::error_code unknown;
  const bool is_begun = std::filesystem::exists(marker_path(), unknown);
  if (unknown) return std::unexpected(unread_ = marker_path() + ": " + unknown.message());
  if (!is_begun) return false;
  ADIT_TRY(store_.forget());
  const network::FactoryRequest forget{host::draw_nonce()};
  ADIT_TRY(host::write_request(state_, network::kForgetFile, forget));
  for (const char* kept : {"journal", "waiting", "rejected"}) {
    std::error_code error;
    std::filesystem::remove_all(runtime_ + '/' + kept, error);
    if (error) return std::unexpected("cannot remove " + runtime_ + '/' + kept + ": " + error.message());
  }
  forward::StampFloor(state_).forget();
  std::error_code error;
  std::filesystem::remove_all(state_ + "/runs", error);
  if (error) return std::unexpected("cannot remove " + state_ + "/runs: " + error.message());
  // Removes the passwords and the mark last, so that an unfinished reset does not look finished.
  for (const std::string& file :
       {runtime_ + '/' + SessionKeeper::kFile, state_ + '/' + AcknowledgementFile::kFile,
        state_ + '/' + access::kCertificateFile, state_ + '/' + access::kCertificateFile + host::kDamaged,
        state_ + '/' + access::kUploadedFile, state_ + '/' + Accounts::kDevicesFile,
        state_ + '/' + Accounts::kCodeFile, state_ + '/' + Accounts::kFile,
        state_ + '/' + Accounts::kFile + host::kDamaged, state_ + '/' + Takeover::kFile, marker_path()}) {
    ADIT_TRY(host::remove_file(file));
  }
  host::log(host::Level::Notice,
            "factory reset: settings, tokens, certificate, passwords and sessions deleted");
  return true;
}

}  // namespace adit::admin
