#include "network/change.hpp"

#include <utility>

#include "icd/sentence.hpp"

namespace adit::network {

void Change::interrupted() {
  status_.ended = Ended::Reverted;
  status_.why = "the change was not confirmed before adit-network ended";
}

void Change::want(const Wanted& wanted, Instant now) {
  if (status_.pending) return;  // the sender sees in the status that its request was ignored
  if (status_.kept == wanted.numbers) {
    status_.ended_nonce = wanted.nonce;
    status_.ended = Ended::Confirmed;
    status_.why = "the box already has these addresses";
    return;
  }
  status_.pending = Pending{wanted.nonce, wanted.numbers, now + wanted.confirm_within, wanted.confirm_within};
  if (const auto applied = hands_.apply(wanted.numbers); !applied) {
    revert("the change could not be applied: " + applied.error(), now);
  }
}

void Change::hear(const Decision& word, Instant now) {
  if (!status_.pending || word.nonce != status_.pending->nonce || try_at_) return;
  if (word.what == Decision::What::Revert) return revert("a user reverted the change", now);
  const Numbers numbers = status_.pending->wanted;
  if (const auto kept = hands_.keep(numbers); !kept) {
    return revert("the change was confirmed, but could not be stored: " + kept.error(), now);
  }
  status_.kept = numbers;
  end(Ended::Confirmed, "");
}

std::expected<void, std::string> Change::forget(Instant now) {
  auto kept = hands_.forget();
  if (!kept) {
    if (status_.pending && !try_at_) revert("a factory reset forgets all addresses", now);
    return std::unexpected(std::move(kept.error()));
  }
  status_.kept = *kept;
  status_.endpoints = {};
  if (status_.pending) end(Ended::Reverted, "a factory reset forgot all addresses");
  return {};
}

void Change::tick(Instant now) {
  if (try_at_) {
    if (now >= *try_at_) try_to_revert(now);
  } else if (status_.pending && now >= status_.pending->until) {
    revert(
        icd::sentence("the change was not confirmed within ",
                      std::chrono::ceil<std::chrono::seconds>(status_.pending->confirm_within).count(), " s"),
        now);
  }
}

void Change::stop(Instant now) {
  if (try_at_) return try_to_revert(now);
  if (status_.pending) revert("adit-network was stopped", now);
}

std::optional<Instant> Change::wake() const {
  if (try_at_) return try_at_;
  return status_.pending ? std::optional(status_.pending->until) : std::nullopt;
}

void Change::revert(std::string why, Instant now) {
  why_ = std::move(why);
  tries_ = 0;
  try_to_revert(now);
}

void Change::try_to_revert(Instant now) {
  const auto reverted = hands_.revert();
  if (reverted) return end(Ended::Reverted, why_);
  if (++tries_ == kTries) {
    return end(Ended::Reverted,
               why_ + "; the old addresses are not in effect yet: retrying: " + reverted.error());
  }
  try_at_ = now + kTryAgain;
}

void Change::end(Ended how, std::string why) {
  status_.ended_nonce = status_.pending->nonce;
  status_.pending.reset();
  status_.ended = how;
  status_.why = std::move(why);
  try_at_.reset();
}

}  // namespace adit::network
