#include "update/last_update.hpp"

#include "icd/sentence.hpp"

namespace adit::update {
namespace {

/// Whether RAUC may have finished writing. RAUC continues if adit-update is killed, and a power cut may lose
/// its answer. A slot that the boot loader left was complete.
bool may_be_whole(Stage stage) {
  return stage != Stage::None && stage != Stage::Good;
}

/// RAUC makes the slot the next one only after it is complete.
bool waits_for_a_restart(const LastUpdate& last_update, const Running& running, const std::string& boot) {
  return may_be_whole(last_update.stage) && last_update.boot == boot && last_update.slot == running.other &&
         running.other_next;
}

}  // namespace

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

LastUpdate settled(LastUpdate last_update, const Running& running, const std::string& boot) {
  if (on_trial(last_update, running, boot) || waits_for_a_restart(last_update, running, boot)) {
    last_update.stage = Stage::Installed;
    last_update.why.clear();
  } else if (last_update.stage == Stage::Installing) {
    last_update.stage = Stage::Interrupted;
    last_update.why = "the update was interrupted: the running slot is unchanged, install the update again";
  } else if (last_update.stage == Stage::Installed && last_update.boot != boot &&
             last_update.slot != running.slot) {
    last_update.stage = Stage::Left;
    last_update.why = icd::sentence("the update did not become healthy in three starts; ", running.version,
                                    " is running again");
  }
  return last_update;
}

bool on_trial(const LastUpdate& last_update, const Running& running, const std::string& boot) {
  return may_be_whole(last_update.stage) && last_update.boot != boot && last_update.slot == running.slot &&
         last_update.version == running.version;
}

}  // namespace adit::update
