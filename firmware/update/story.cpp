#include "update/story.hpp"

#include "icd/sentence.hpp"

namespace adit::update {
namespace {

/// Whether RAUC came to its end is known for certain only of what it said in time: it goes on by itself where
/// adit-update is killed or waits no longer, and the power may go before its answer is kept.
bool may_be_whole(Stage stage) {
  return stage == Stage::Installing || stage == Stage::Interrupted || stage == Stage::Failed ||
         stage == Stage::Installed;
}

/// RAUC has the slot that it writes started next once all of it is written.
bool waits_for_a_restart(const Story& story, const Running& running, const std::string& boot) {
  return may_be_whole(story.stage) && story.boot == boot && story.slot == running.other && running.other_next;
}

}  // namespace

std::string_view name_of(Stage stage) {
  switch (stage) {
    case Stage::Installing:
      return "installing";
    case Stage::Interrupted:
      return "interrupted";
    case Stage::Failed:
      return "failed";
    case Stage::Installed:
      return "installed";
    case Stage::Left:
      return "left";
    case Stage::Good:
      return "good";
    case Stage::None:
      break;
  }
  return "";
}

Story settled(Story story, const Running& running, const std::string& boot) {
  if (on_trial(story, running.slot, boot) || waits_for_a_restart(story, running, boot)) {
    story.stage = Stage::Installed;
    story.why.clear();
  } else if (story.stage == Stage::Installing) {
    story.stage = Stage::Interrupted;
    story.why = "it was interrupted: what runs was not touched, install it again";
  } else if (story.stage == Stage::Installed && story.boot != boot && story.slot != running.slot) {
    story.stage = Stage::Left;
    story.why =
        icd::sentence("it did not come up healthy in three starts, and ", running.version, " runs again");
  }
  return story;
}

bool on_trial(const Story& story, const std::string& slot, const std::string& boot) {
  return may_be_whole(story.stage) && story.boot != boot && story.slot == slot;
}

}  // namespace adit::update
