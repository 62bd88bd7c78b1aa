#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"

namespace adit::applier {

/// Who answers on the link for the Command Post's endpoints, by what adit-network tells: these, or the
/// gateway to them; in order, none twice, at most Takers::kMost. `own`: the box's addresses on that side,
/// where adit-network has none of its own. None that is in a subnet of the team's: where the two overlap, it
/// may be a robot's as well.
std::vector<std::uint32_t> sought_in(const network::Status& status, const std::vector<settings::Subnet>& own,
                                     const std::vector<settings::Subnet>& team);

/// adit-network's status, read by another program, and when it is another.
class ToldStatus {
 public:
  /// `folder`: adit-network's, which may come later. `changed` is called once it may be another. `loop`
  /// outlives this.
  ToldStatus(loop::Loop& loop, std::string folder, std::function<void()> changed);

  /// Nothing told: no endpoints.
  network::Status read() const;

 private:
  /// Between two looks for a folder that is not there yet.
  static constexpr std::chrono::seconds kLookAgain{10};
  void watch_folder();

  loop::Loop& loop_;
  const std::string folder_;
  const std::function<void()> changed_;
  loop::FileDescriptor notices_;
  loop::Source noticed_, due_;
};

}  // namespace adit::applier
