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

/// The box's version and the state of its update.
struct UpdateView {
  bool managed = false;    // whether it can be updated here
  std::string why;         // why not, or ""
  bool runs_here = false;  // whether adit-update runs, is starting, or has an unreadable status
  update::Status status;   // of adit-update, or "receiving" with its per cent, without an earlier refusal
  std::optional<std::string> newer;  // newer version that apt has; "": none; std::nullopt: not known
  std::string newer_why;             // why that cannot be read, or ""

  static const codec::Row kRow;
};

/// A bundle being received. Destroying it before finish() discards it.
class Upload {
 public:
  virtual ~Upload() = default;
  /// Accepts a piece, valid during the call. False: pause until `resume` (Updates::receive()).
  virtual bool write(std::span<const std::uint8_t> piece) = 0;
  /// Ends the upload. Once the bundle is on disk, requests its installation and passes the result to `done`.
  virtual void finish(std::function<void(icd::Checked<void>)> done) = 0;
};

/// Updates the box. A refusal says why not.
class Updates {
 public:
  virtual ~Updates() = default;
  virtual UpdateView state() const = 0;
  /// Starts to receive a bundle of `size` bytes, one at a time. `again`: allows the running version.
  virtual icd::Checked<std::unique_ptr<Upload>> receive(std::uint64_t size, bool again,
                                                        std::function<void()> resume) = 0;
  /// Installs the stick's update.
  virtual icd::Checked<void> install_from_stick(bool again) = 0;
  /// Restarts the box. Rejected while a report is in flight, unless `anyway`.
  virtual icd::Checked<void> restart(bool anyway) = 0;
  /// If UpdateView::stray is set: restarts into the proven slot.
  virtual icd::Checked<void> restart_proven_slot(bool anyway) = 0;
  /// If UpdateView::stray is set: makes the running slot the proven one.
  virtual icd::Checked<void> keep_running_slot() = 0;
};

}  // namespace adit::api
