#include "update/proven.hpp"

#include "icd/sentence.hpp"

namespace adit::update {

Proven proven_now(Proven before, const Running& running, bool trial) {
  const bool another = !before.slot.empty() && before.slot != running.slot;
  if (another && !trial) return before;
  return {running.slot, running.version};
}

std::string stray(const Proven& proven, const Running& running, bool trial) {
  if (proven.slot.empty() || proven.slot == running.slot || trial) return "";
  const char* why =
      running.other_good
          ? "although that slot has starts left: a user chose the running slot, or the boot loader lost its "
            "counts"
          : "because that slot has used up its starts, by power cuts or because it does not come up";
  return icd::sentence("slot ", running.slot, " is running, with ", running.version, ", not slot ",
                       proven.slot, " with ", proven.version, ", ", why);
}

std::string stray_if_unknown(const Running& running, bool trial, std::string_view why) {
  if (trial) return "";
  return icd::sentence("slot ", running.slot, " is running, with ", running.version,
                       ", and may not be the last good one: ", why);
}

}  // namespace adit::update
