#include "host/inherited.hpp"

#include <systemd/sd-daemon.h>

#include <cstdlib>
#include <cstring>
#include <memory>

namespace adit::host {

std::expected<std::vector<Inherited>, std::string> inherited() {
  char** names = nullptr;
  const int count = sd_listen_fds_with_names(1, &names);
  if (count < 0) {
    return std::unexpected(std::string("reading the sockets from systemd: ") + std::strerror(-count));
  }
  std::vector<Inherited> all;
  for (int i = 0; i < count; ++i) {
    const std::unique_ptr<char, decltype(&std::free)> name(names[i], &std::free);
    all.push_back({.name = name.get(), .descriptor = loop::FileDescriptor(SD_LISTEN_FDS_START + i)});
  }
  std::free(static_cast<void*>(names));
  return all;
}

void store_descriptor(const std::string& name, int descriptor) {
  sd_pid_notify_with_fds(0, 0, ("FDSTORE=1\nFDNAME=" + name).c_str(), &descriptor, 1);
}

void forget_descriptor(const std::string& name) {
  sd_notify(0, ("FDSTOREREMOVE=1\nFDNAME=" + name).c_str());
}

}  // namespace adit::host
