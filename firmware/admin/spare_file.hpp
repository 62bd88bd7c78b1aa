#pragma once

#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/run_status.hpp"

namespace adit::admin {

/// That the box rests.
struct Rest {
  std::string code = "";  // of its export
  double since = 0;       // seconds since 1970
  /// What /api/status would have answered once nothing was under way any more; nothing: not known for
  /// certain.
  std::optional<icd::RunStatus> expected = std::nullopt;
  static const codec::Row kRow;
};

/// An export that was taken over from.
struct TakenFrom {
  std::string box = "";
  double at = 0;  // when that box came to rest
  static const codec::Row kRow;
};

/// What a box keeps of itself and its spare, in the state folder: it must outlive everything.
struct SpareFile {
  std::string box = "";  // its own number; "": it drew none yet
  std::optional<Rest> rest = std::nullopt;
  std::vector<TakenFrom> taken = {};

  static const codec::Row kRow;
  static constexpr const char* kName = "spare.json";
  /// One that is not there yet is new.
  static std::expected<SpareFile, std::string> read(const std::string& state_folder);
  std::expected<void, std::string> write(const std::string& state_folder) const;

  /// Why an export of that box must not be taken over from; "": it may.
  std::string hindrance(const std::string& its_box, double at) const;
};

}  // namespace adit::admin
