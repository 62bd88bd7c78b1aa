#pragma once

#include <functional>
#include <optional>
#include <string>

#include "api/spare.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"
#include "spare/stick.hpp"

namespace adit::admin {

/// Exports to and from the USB stick in the box, copied by adit-spare (firmware/rules/spare/README.md).
class SpareStick {
 public:
  /// Time in which adit-spare must read a request.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// Interval at which a request's result is read.
  static constexpr std::chrono::milliseconds kLook{100};

  using Taken = std::function<void(std::string)>;

  /// `state_folder`: for requests. `status_folder`: for answers. `taken` receives each export read from a
  /// stick. `loop` must outlive this object.
  SpareStick(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder,
             Taken taken);

  /// std::nullopt: adit-spare does not run here.
  std::optional<api::StickRow> view() const;
  /// Refuses if requests are impossible now.
  icd::Checked<void> check_free() const;
  /// Writes the whole file under that name.
  icd::Checked<void> write(const std::string& name, const std::string& file);
  icd::Checked<void> take(const std::string& name);

 private:
  using What = spare::StickRequest::What;
  icd::Checked<void> ask(What what, const std::string& name);
  void look();
  void finish(const spare::StickStatus& status);
  std::string for_stick() const { return adit_spare_.requests() + '/' + spare::kForStickFile; }

  loop::Loop& loop_;
  host::RootProgram<spare::StickStatus> adit_spare_;
  Taken taken_;
  loop::Source timer_;
  std::optional<What> asked_;  // until it is finished
  std::string refusal_;        // why the last request failed
};

}  // namespace adit::admin
