#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/box.hpp"
#include "api/source.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "settings/board.hpp"
#include "settings/settings.hpp"

namespace adit::box {

/// The two cables. The kernel reports changes, so that the page shows them and retries start at once.
class Links {
 public:
  using CarrierReader = std::function<std::optional<bool>(const std::string& interface)>;

  /// `changed`: a cable came or went. `back`: after it, if the Command Post's came. `look`: host::carrier().
  /// `kernel`: host::link_changes(), or empty.
  Links(loop::Loop& loop, const settings::Settings& settings, CarrierReader look, loop::FileDescriptor kernel,
        std::function<void()> changed, std::function<void()> back);

  /// Call once a second, because the kernel may miss a change.
  void refresh();

  /// Takes the interfaces of changed settings.
  void watch_settings(const settings::Settings& settings);

  /// The team's, then the Command Post's, without unnamed interfaces.
  std::vector<facts::LinkRow> rows() const;

 private:
  struct Link {
    std::string side, interface;
    std::optional<bool> carrier = {};
  };

  CarrierReader look_;
  std::function<void()> changed_, back_;
  std::array<Link, 2> links_;
  const loop::FileDescriptor kernel_;
  loop::Source told_;
};

/// Contents of the board's file.
struct KnownBoard {
  settings::Board board;  // empty without a file
  std::string trouble;    // why the file is ignored, or ""
};
/// `file` may be "" or absent.
KnownBoard read_board(const std::string& file);

/// Sentences of root's programs for the operator, one per file in `folder`, by file name. Empty if the
/// directory is absent. A sentence replaces what cannot be read.
std::map<std::string, std::string> read_notices(const std::string& folder);

/// The page's facts about the box, from the kernel, the logger and the libraries.
class ThisBox final : public api::Box {
 public:
  /// `add_to` adds the gateway's counts. `loop` and `workers` outlive this.
  ThisBox(const loop::Loop& loop, loop::Workers& workers, settings::Board board, std::string settings,
          std::function<void(api::Usage&)> add_to);

  std::vector<api::LogRecord> log(std::uint64_t after) const override;
  std::uint64_t last_record_number() const override;
  api::Usage usage() const override;
  api::About about() const override;
  api::NetworkState network() const override;
  std::string settings() const override { return settings_; }
  void set_settings(std::string settings) { settings_ = std::move(settings); }
  void work(std::function<void()> work, std::function<void()> done) override;

 private:
  /// Of the process, by the present time of day. The process may have had earlier gateways.
  api::Time start_time() const;

  const loop::Loop& loop_;
  loop::Workers& workers_;
  settings::Board board_;
  std::string settings_;
  std::function<void(api::Usage&)> add_to_;
};

}  // namespace adit::box
