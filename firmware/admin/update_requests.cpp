#include "admin/update_requests.hpp"

#include <unistd.h>

#include "host/service.hpp"

namespace adit::admin {

std::expected<update::Status, std::string> UpdateRequests::status() const {
  const auto text = host::read_file(status_ + '/' + update::kStatusFile);
  if (!text) return std::unexpected(text.error());
  return update::read<update::Status>(*text);
}

std::expected<void, std::string> UpdateRequests::ask(const update::Request& request) {
  return host::write_file(state_ + '/' + update::kRequestFile, update::write(request), host::kOursAlone);
}

void UpdateRequests::forget() {
  unlink((state_ + '/' + update::kRequestFile).c_str());
  unlink(bundle_file().c_str());
}

}  // namespace adit::admin
