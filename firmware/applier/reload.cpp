#include "applier/reload.hpp"

#include "host/log.hpp"
#include "host/output.hpp"
#include "host/service.hpp"

namespace adit::applier {

bool Reload::is_due() const {
  return is_due_ || host::may_exist(file());
}

void Reload::set_due() {
  if (is_due()) return;
  is_due_ = true;
  host::log_failure(host::Level::Error, "cannot note that networkd has to read its files",
                    host::write_file(file(), "", host::kForAll));
}

std::expected<void, std::string> Reload::run() {
  if (!is_due()) return {};
  if (auto read = host::run_command({options_.networkctl, "reload"}, kWithin); !read) return read;
  is_due_ = false;
  return host::remove_file(file());
}

}  // namespace adit::applier
