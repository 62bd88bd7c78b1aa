#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/run_status.hpp"
#include "icd/status.hpp"

namespace adit::api {

/// An export of another box, taken in and opened, and not used yet.
struct ExportRow {
  std::string name, version;  // of the box: where the team found it; its Adit
  double at = 0;              // when that box came to rest; seconds since 1970
  std::int64_t reports = 0, open = 0;
  std::string post;
  std::optional<icd::RunStatus> run;
  std::vector<std::string> left_out = {};  // settings that are not known here: their paths
  static const codec::Row kRow;
};

/// An export on the stick in the box, as its name tells of it.
struct StickExportRow {
  std::string name;  // of the file
  std::string box;   // where the team found the box that made it; "": the name does not say
  std::optional<double> at;
  static const codec::Row kRow;
};

/// What exports and the stick in the box have to do with each other.
struct StickRow {
  std::string hindrance;  // why no export can be written to it; "": it can
  std::string doing;      // "writing", "checking", "reading"; "": nothing
  std::string refusal;    // why the last that was asked of it came to nothing; or ""
  std::string written;    // the file of this box's export that is on it, read back and whole; or ""
  std::vector<StickExportRow> exports;  // the latest first
  static const codec::Row kRow;
};

/// How the box stands to its spare, or to the box that it is the spare of.
struct SpareView {
  bool standby = false;
  std::string why;              // it is on standby; "" if it is not
  std::optional<double> since;  // when standby began; seconds since 1970
  std::string code;             // of its export, in groups; "": there is none
  bool asks_code = false;       // an export was taken in, and waits for its code
  std::optional<ExportRow> taken_in;
  bool takes_over = false;        // that is under way
  std::optional<StickRow> stick;  // nothing: here no stick is written or read
  static const codec::Row kRow;
};

/// The export for a spare box, and its taking in. A refusal says why not.
class Spare {
 public:
  using Sealed = std::function<void(icd::Checked<std::string>)>;
  using Done = std::function<void(icd::Checked<void>)>;

  virtual ~Spare() = default;
  virtual SpareView spare() const = 0;
  /// From now on the box takes nothing and sends nothing, until resume(), also after a power cut.
  virtual icd::Checked<void> stand_by() = 0;
  virtual icd::Checked<void> resume() = 0;
  /// The export's file, later. Only on standby.
  virtual void export_to(Sealed done) = 0;
  /// Writes it to the stick in the box: `done` once that is asked for. Only on standby.
  virtual void export_to_stick(Done done) = 0;
  /// Takes in the export of that name on the stick, soon.
  virtual icd::Checked<void> take_from_stick(const std::string& name) = 0;
  /// Takes in an export; one that was taken in before is forgotten.
  virtual icd::Checked<void> take_in(std::string file) = 0;
  /// Opens it by its code; `done`, later.
  virtual void open(const std::string& code, Done done) = 0;
  virtual icd::Checked<void> forget() = 0;
  /// Soon the box goes on where the other one came to rest.
  virtual icd::Checked<void> take_over() = 0;
};

}  // namespace adit::api
