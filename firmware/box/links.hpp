#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/source.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::box {

/// The two cables: looked at often, so that one that is out is shown, and what waited for it goes on as soon
/// as it is back.
class Links {
 public:
  static constexpr std::chrono::milliseconds kEvery{250};
  using Look = std::function<std::optional<bool>(const std::string& interface)>;

  /// `changed` is called as a cable comes or goes, `back` after it where the Command Post's came.
  /// `look`: host::carrier().
  Links(loop::Loop& loop, const settings::Settings& settings, Look look, std::function<void()> changed,
        std::function<void()> back);

  /// The settings may name others from now on.
  void look_at(const settings::Settings& settings);

  /// The team's, then the Command Post's; without one whose interface the settings do not name.
  std::vector<api::LinkRow> rows() const;
  /// For the operator: which cable is out.
  std::vector<std::string> attention() const;

 private:
  struct Link {
    std::string side, whose, interface;
    std::optional<bool> carrier = {};
  };
  void look();

  loop::Loop& loop_;
  Look look_;
  std::function<void()> changed_, back_;
  std::array<Link, 2> links_;
  loop::Source timer_;
};

}  // namespace adit::box
