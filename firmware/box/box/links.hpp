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

/// The two cables. The kernel reports changes, so that the page shows them and retries start at once.
class Links {
 public:
  using Look = std::function<std::optional<bool>(const std::string& interface)>;

  /// `changed`: a cable came or went. `back`: after it, if the Command Post's came. `look`: host::carrier().
  /// `kernel`: host::link_changes(), or empty.
  Links(loop::Loop& loop, const settings::Settings& settings, Look look, loop::FileDescriptor kernel,
        std::function<void()> changed, std::function<void()> back);

  /// Call once a second, because the kernel may miss a change.
  void look();

  /// Takes the interfaces of changed settings.
  void look_at(const settings::Settings& settings);

  /// The team's, then the Command Post's, without unnamed interfaces.
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
