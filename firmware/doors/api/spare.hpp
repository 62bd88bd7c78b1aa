#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/scoring.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// Another box's export, imported and opened, not used yet.
struct ExportRow {
  std::string name, version;  // its address for the team; its Adit
  double at = 0;              // start of its standby; seconds since 1970
  std::int64_t reports = 0, open = 0;
  std::string post;
  std::optional<icd::RunStatus> run;
  std::int64_t port = 0;  // first of its ports for the team, at which this box listens after the take-over
  std::vector<std::string> left_out = {};  // paths of settings unknown here
  static const codec::Row kRow;
};

/// An export on the stick, described by its name.
struct StickExportRow {
  std::string name;  // of the file
  std::string box;   // address of the exporting box; "": not in the name
  std::optional<double> at;
  static const codec::Row kRow;
};

/// The stick in the box.
struct StickRow {
  std::string hindrance;                // why no export can be written, or ""
  std::string unreadable;               // without exports: why the stick cannot be read, or ""
  std::string doing;                    // "writing", "checking", "reading" or ""
  std::string refusal;                  // why the last request failed, or ""
  std::string written;                  // the verified file of this box's export, or ""
  std::vector<StickExportRow> exports;  // the latest first
  static const codec::Row kRow;
};

/// The box's state as a standby or a spare.
struct SpareView {
  bool standby = false;
  std::string why;              // why the box is a standby, or ""
  std::optional<double> since;  // start of the standby; seconds since 1970
  std::string code;             // of its export, in groups; or ""
  bool asks_code = false;       // an imported export needs its code
  std::optional<ExportRow> taken_in;
  bool takes_over = false;        // a takeover is in progress
  std::optional<StickRow> stick;  // nullopt: sticks cannot be used here
  static const codec::Row kRow;
};

/// Export for a spare box, and import. A refusal says why not.
class Spare {
 public:
  using Sealed = std::function<void(icd::Checked<std::string>)>;
  using Done = std::function<void(icd::Checked<void>)>;

  virtual ~Spare() = default;
  virtual SpareView state() const = 0;
  /// Makes the box a standby until resume(), across power cuts.
  virtual icd::Checked<void> enter_standby() = 0;
  virtual icd::Checked<void> resume() = 0;
  /// Passes the export's file to `done` later. Only on standby.
  virtual void export_to(Sealed done) = 0;
  /// Requests an export to the stick, then calls `done`. Only on standby.
  virtual void export_to_stick(Done done) = 0;
  /// Requests the import of that export from the stick.
  virtual icd::Checked<void> import_from_stick(const std::string& name) = 0;
  /// Imports an export in place of an earlier one.
  virtual icd::Checked<void> import_file(std::string file) = 0;
  /// Opens the import with its code. Calls `done` later.
  virtual void open(const std::string& code, Done done) = 0;
  virtual icd::Checked<void> forget() = 0;
  virtual icd::Checked<void> take_over() = 0;
};

}  // namespace adit::api
