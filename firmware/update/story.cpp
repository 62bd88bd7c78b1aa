#include "update/story.hpp"

#include "icd/sentence.hpp"

namespace adit::update {

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
  if (story.stage == Stage::Installing) {
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
  return story.stage == Stage::Installed && story.boot != boot && story.slot == slot;
}

}  // namespace adit::update
