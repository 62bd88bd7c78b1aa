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
