#include "gateway/factory_reset.hpp"

#include <filesystem>
#include <utility>

#include "gateway/accounts.hpp"
#include "gateway/network_requests.hpp"
#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::gateway {

FactoryReset::FactoryReset(const Store& store, std::string state_folder, std::string runtime_folder)
    : store_(store), state_(std::move(state_folder)), runtime_(std::move(runtime_folder)) {}

std::expected<void, std::string> FactoryReset::begin() const {
  return host::write_file(begun(), "", host::kOursAlone);
}

std::expected<void, std::string> FactoryReset::finish() const {
  std::error_code unknown;
  const bool is_begun = std::filesystem::exists(begun(), unknown);
  if (unknown) return std::unexpected(begun() + ": " + unknown.message());
  if (!is_begun) return {};
  if (auto done = store_.forget(); !done) return done;
  const NetworkRequests network(state_, "");
  if (auto asked = network.ask(network::Forget{NetworkRequests::draw_nonce()}); !asked) return asked;
  // Last: until then the box does not look as if it were reset.
  for (const std::string& file : {runtime_ + '/' + SessionKeeper::kFile, state_ + '/' + Accounts::kCodeFile,
                                  state_ + '/' + Accounts::kFile, begun()}) {
    if (auto done = host::remove_file(file); !done) return done;
  }
  host::log(host::Level::Notice, "all that was set up is forgotten");
  return {};
}

}  // namespace adit::gateway
