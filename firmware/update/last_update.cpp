#include "update/last_update.hpp"

#include "icd/sentence.hpp"

namespace adit::update {
namespace {

/// Whether RAUC came to its end is known for certain only of what it said: it goes on by itself where
/// adit-update is killed, and the power may go before its answer is kept. What was left is whole, too.
bool may_be_whole(Stage stage) {
  return stage != Stage::None && stage != Stage::Good;
}

/// RAUC has the slot that it writes started next once all of it is written.
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
