#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"

namespace adit::applier {

/// Addresses that answer on the link for the Command Post's endpoints: the endpoints or their gateway.
/// Sorted, without duplicates, at most Takers::kMost. `own`: the box's addresses on that side, used if
/// adit-network has none. Addresses in a subnet of `team` are left out, because a robot may have them.
std::vector<std::uint32_t> sought_in(const network::Status& status, const std::vector<settings::Subnet>& own,
                                     const std::vector<settings::Subnet>& team);

/// adit-network's status, read by another program, with notices of changes.
class ToldStatus {
 public:
  /// `folder`: of adit-network; may appear later. `changed` is called after each possible change. `loop` must
  /// outlive this object.
  ToldStatus(loop::Loop& loop, std::string folder, std::function<void()> changed);

  /// Without a status: no endpoints.
  network::Status read() const;

 private:
  /// Interval of looks for a missing directory.
  static constexpr std::chrono::seconds kLookAgain{10};
  void watch_folder();

  loop::Loop& loop_;
  const std::string folder_;
  const std::function<void()> changed_;
  loop::FileDescriptor notices_;
  loop::Source noticed_, due_;
};

}  // namespace adit::applier
