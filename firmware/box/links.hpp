#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/source.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::box {

/// The two cables: looked at as soon as the kernel tells of a change, so that one that is out is shown, and
/// what waited for it goes on as soon as it is back.
class Links {
 public:
  using Look = std::function<std::optional<bool>(const std::string& interface)>;

  /// `changed` is called as a cable comes or goes, `back` after it where the Command Post's came.
  /// `look`: host::carrier(). `kernel`: host::link_changes(), or none.
  Links(loop::Loop& loop, const settings::Settings& settings, Look look, loop::FileDescriptor kernel,
        std::function<void()> changed, std::function<void()> back);

  /// To be called each second: the kernel may have told of nothing.
  void look();

  /// The settings may name others from now on.
  void look_at(const settings::Settings& settings);

  /// The team's, then the Command Post's; without one whose interface the settings do not name.
  std::vector<api::LinkRow> rows() const;

 private:
  struct Link {
    std::string side, interface;
    std::optional<bool> carrier = {};
  };

  Look look_;
  std::function<void()> changed_, back_;
  std::array<Link, 2> links_;
  const loop::FileDescriptor kernel_;
  loop::Source told_;
};

}  // namespace adit::box
