#include "update/messages.hpp"

#include "codec/nonce.hpp"
#include "icd/sentence.hpp"

namespace adit::update {
namespace {

/// Whether RAUC may have finished writing. RAUC continues if adit-update is killed, and a power cut may lose
/// its answer. A slot that the boot loader left was complete.
bool can_be_complete(Stage stage) {
  return stage != Stage::None && stage != Stage::Good;
}

/// RAUC makes the slot the next one only after it is complete.
bool waits_for_a_restart(const LastUpdate& last_update, const RunningSystem& running,
                         const std::string& boot) {
  return can_be_complete(last_update.stage) && last_update.boot == boot &&
         last_update.slot == running.other && running.other_next;
}

}  // namespace

ProvenSlot proven_now(ProvenSlot before, const RunningSystem& running, bool trial) {
  const bool another = !before.slot.empty() && before.slot != running.slot;
  if (another && !trial) return before;
  return {running.slot, running.version};
}

std::string slot_warning(const ProvenSlot& proven, const RunningSystem& running, bool trial) {
  if (proven.slot.empty() || proven.slot == running.slot || trial) return "";
  const char* why =
      running.other_good
          ? "although that slot has starts left: a user chose the running slot, or the boot loader lost its "
            "counts"
          : "because that slot has used up its starts, by power cuts or because it does not come up";
  return icd::sentence("slot ", running.slot, " is running, with ", running.version, ", not slot ",
                       proven.slot, " with ", proven.version, ", ", why);
}

std::string stray_if_unknown(const RunningSystem& running, bool trial, std::string_view why) {
  if (trial) return "";
  return icd::sentence("slot ", running.slot, " is running, with ", running.version,
                       ", and may not be the last good one: ", why);
}

LastUpdate settle_update(LastUpdate last_update, const RunningSystem& running, const std::string& boot) {
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

bool on_trial(const LastUpdate& last_update, const RunningSystem& running, const std::string& boot) {
  return can_be_complete(last_update.stage) && last_update.boot != boot && last_update.slot == running.slot &&
         last_update.version == running.version;
}

static constexpr std::string_view kCommandWords[] = {"install", "stick", "restart", "back",
                                                     "stay"};  // in the order of Request::Command
static constexpr auto& words_of(Request::Command /*of*/) {
  return kCommandWords;
}

namespace {

using codec::member;
using codec::Member;
using codec::Row;

constexpr Member kRequestMembers[] = {
    member<&Request::nonce>("nonce").matching(codec::kNonce),
    member<&Request::what>("what"),
    member<&Request::again>("again"),
};
constexpr Member kRunningMembers[] = {
    member<&RunningSystem::compatible>("compatible"),
    member<&RunningSystem::version>("version"),
    member<&RunningSystem::slot>("slot"),
    member<&RunningSystem::other>("other"),
};
constexpr Member kOfferMembers[] = {
    member<&Offer::name>("name"),
    member<&Offer::version>("version"),
};
constexpr Member kLastUpdateMembers[] = {
    member<&LastUpdate::stage>("stage"), member<&LastUpdate::version>("version"),
    member<&LastUpdate::slot>("slot"),   member<&LastUpdate::boot>("boot"),
    member<&LastUpdate::why>("why"),
};
constexpr Member kProvenMembers[] = {
    member<&ProvenSlot::slot>("slot"),
    member<&ProvenSlot::version>("version"),
};
constexpr Member kStatusMembers[] = {
    member<&Status::trouble>("trouble"),
    member<&Status::running>("running"),
    member<&Status::nonce>("nonce"),
    member<&Status::refusal>("refusal"),
    member<&Status::doing>("doing"),
    member<&Status::progress>("progress").from(0).to(100),
    member<&Status::last>("last"),
    member<&Status::trial>("trial"),
    member<&Status::stray>("stray"),
    member<&Status::stick>("stick"),
    member<&Status::stick_trouble>("stick_trouble"),
};

}  // namespace

constexpr Row Request::kRow = codec::complete<Request>({"", kRequestMembers});
constexpr Row RunningSystem::kRow = codec::complete<RunningSystem, 2>({"", kRunningMembers});
constexpr Row Offer::kRow = codec::complete<Offer>({"", kOfferMembers});
constexpr Row LastUpdate::kRow = codec::complete<LastUpdate>({"", kLastUpdateMembers});
constexpr Row ProvenSlot::kRow = codec::complete<ProvenSlot>({"", kProvenMembers});
constexpr Row Status::kRow = codec::complete<Status>({"", kStatusMembers});

}  // namespace adit::update
