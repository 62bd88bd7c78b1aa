#pragma once

#include <expected>
#include <functional>
#include <optional>
#include <string>

#include "api/spare.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"
#include "spare/stick.hpp"

namespace adit::admin {

/// Exports to and from the USB stick in the box, as adit-spare carries them (firmware/spare/README.md).
class SpareStick {
 public:
  /// adit-spare begins within that time, unless it does not run here.
  static constexpr std::chrono::seconds kTakenUpWithin{60};
  /// How often it is looked what became of a request.
  static constexpr std::chrono::milliseconds kLook{100};

  using Taken = std::function<void(std::string)>;

  /// `state_folder`: where requests are left; `status_folder`: where they are answered. `taken` is given each
  /// export that was read from a stick. `loop` outlives this.
  SpareStick(loop::Loop& loop, const std::string& state_folder, const std::string& status_folder,
             Taken taken);

  /// Nothing: adit-spare does not run here.
  std::optional<api::StickRow> view() const;
  /// Why nothing can be asked for now; nothing: it can.
  std::optional<icd::Refusal> hindrance() const;
  /// The whole file, under that name.
  icd::Checked<void> write(const std::string& name, const std::string& file);
  icd::Checked<void> take(const std::string& name);

 private:
  using What = spare::StickRequest::What;
  /// Why no export can be written now.
  std::optional<icd::Refusal> hindrance_to_write() const;
  icd::Checked<void> ask(What what, const std::string& name);
  void look();
  void finish(const spare::StickStatus& status);
  std::string for_stick() const { return adit_spare_.requests() + '/' + spare::kForStickFile; }

  loop::Loop& loop_;
  host::RootProgram<spare::StickStatus> adit_spare_;
  Taken taken_;
  loop::Source timer_;
  std::optional<What> asked_;  // and not finished yet
  std::string refusal_;        // why the last came to nothing
};

}  // namespace adit::admin
