#include "admin/network_requests.hpp"

#include <unistd.h>

#include "host/service.hpp"

namespace adit::admin {

std::expected<network::Status, std::string> NetworkRequests::status() const {
  const auto text = host::read_file(status_ + '/' + network::kStatusFile);
  if (!text) return std::unexpected(text.error());
  return network::read<network::Status>(*text);
}

std::optional<network::Probed> NetworkRequests::probed() const {
  const auto text = host::read_file(status_ + '/' + network::kProbedFile);
  if (!text) return std::nullopt;
  auto probed = network::read<network::Probed>(*text);
  return probed ? std::optional(std::move(*probed)) : std::nullopt;
}

network::Taken NetworkRequests::taken() const {
  const auto text = host::read_file(watch_ + '/' + network::kTakenFile);
  return text ? network::read<network::Taken>(*text).value_or(network::Taken{}) : network::Taken{};
}

std::expected<void, std::string> NetworkRequests::ask(const network::Wanted& wanted) {
  return host::write_file(state_ + '/' + network::kWantedFile, network::write(wanted), host::kOursAlone);
}
std::expected<void, std::string> NetworkRequests::ask(const network::Word& word) {
  return host::write_file(state_ + '/' + network::kWordFile, network::write(word), host::kOursAlone);
}
std::expected<void, std::string> NetworkRequests::ask(const network::Probe& probe) {
  return host::write_file(state_ + '/' + network::kProbeFile, network::write(probe), host::kOursAlone);
}
std::expected<void, std::string> NetworkRequests::ask(const network::Endpoints& endpoints) {
  return host::write_file(state_ + '/' + network::kEndpointsFile, network::write(endpoints),
                          host::kOursAlone);
}
std::expected<void, std::string> NetworkRequests::ask(const network::Forget& forget) {
  return host::write_file(state_ + '/' + network::kForgetFile, network::write(forget), host::kOursAlone);
}

void NetworkRequests::forget_wanted() {
  unlink((state_ + '/' + network::kWantedFile).c_str());
}

}  // namespace adit::admin
