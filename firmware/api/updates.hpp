#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "codec/row.hpp"
#include "icd/status.hpp"
#include "update/messages.hpp"

namespace adit::api {

/// The box's version, and how an update of it stands.
struct UpdateView {
  bool managed = false;  // it can be updated here
  std::string why;       // why not; "" where it can
  update::Running running;
  std::string doing;            // "": nothing
  std::optional<int> progress;  // per cent of receiving and installing
  std::string refusal;          // why the last one was not installed; "" where it was, or there was none
  update::LastUpdate last;
  bool trial = false;  // what runs was installed last, and has not been healthy for long yet
  std::string stray;   // which other slot runs than the one that was good last, and why; "": none does
  std::optional<update::Offer> stick;
  std::string stick_why;  // why what is on a stick cannot be installed; "" where there is none

  static const codec::Row kRow;
};

/// A bundle on its way in. Dropping it before finish() forgets it.
class Upload {
 public:
  virtual ~Upload() = default;
  /// Takes a piece, valid during the call. False: no more until `resume` (Updates::receive()) is called.
  virtual bool write(std::span<const std::uint8_t> piece) = 0;
  /// It is whole: asks for its installation once it is on the disk, and says whether that could be asked for.
  virtual void finish(std::function<void(icd::Checked<void>)> done) = 0;
};

/// What updates the box. A refusal says why not.
class Updates {
 public:
  virtual ~Updates() = default;
  virtual UpdateView update() const = 0;
  /// Begins to receive a bundle of `size` bytes; one at a time. `again`: also the version that runs.
  virtual icd::Checked<std::unique_ptr<Upload>> receive(std::uint64_t size, bool again,
                                                        std::function<void()> resume) = 0;
  /// Installs what the USB stick has.
  virtual icd::Checked<void> install_from_stick(bool again) = 0;
  /// Restarts the box. Unless `anyway`, not while a report is under way.
  virtual icd::Checked<void> restart(bool anyway) = 0;
  /// Where UpdateView::stray says so: restarts the box into the slot that was good last.
  virtual icd::Checked<void> go_back(bool anyway) = 0;
  /// Where UpdateView::stray says so: the slot that runs is the one to keep.
  virtual icd::Checked<void> stay() = 0;
};

}  // namespace adit::api
