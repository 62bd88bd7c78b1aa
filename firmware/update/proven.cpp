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
  const char* why = running.other_good
                        ? "though its starts are not used up: somebody chose this one, or the boot loader's "
                          "counts were lost"
                        : "whose starts were used up, by power cuts or because it does not come up";
  return icd::sentence("slot ", running.slot, " runs, with ", running.version, ", not slot ", proven.slot,
                       " with ", proven.version, ", ", why);
}

}  // namespace adit::update
