#include "intake/token_guesses.hpp"

#include <algorithm>
#include <utility>

#include "icd/bearer_token.hpp"

namespace adit::intake {

TokenGuesses::Verdict TokenGuesses::right(const std::string& address, loop::Instant now) {
  Count& count = count_of(address, now);
  if (!count.has_been_right && !count.guesses.has_one(now)) return {Looked::NotLookedAt, true};
  count.has_been_right = true;
  return {Looked::Right, false};
}

TokenGuesses::Verdict TokenGuesses::wrong(const std::string& address, std::string_view token,
                                          loop::Instant now) {
  Count& count = count_of(address, now);
  const std::string_view kept = token.substr(0, icd::BearerToken::kLongest + 1);  // longer: no token
  if (std::ranges::find(count.wrong, kept) == count.wrong.end()) {
    if (!count.guesses.has_one(now)) return {Looked::NotLookedAt, true};
    count.guesses.use(now);
    count.wrong[std::exchange(count.next, (count.next + 1) % count.wrong.size())] = kept;
  }
  const bool late = !count.answers.has_one(now);
  if (!late) count.answers.use(now);
  return {Looked::Wrong, late};
}

TokenGuesses::Count& TokenGuesses::count_of(const std::string& address, loop::Instant now) {
  if (!counts_.contains(address) && counts_.size() >= kMostAddresses) {
    counts_.erase(std::ranges::min_element(counts_, {}, [](const auto& each) {
      return std::pair(each.second.has_been_right, each.second.last);
    }));
  }
  Count& count = counts_[address];
  count.last = now;
  return count;
}

}  // namespace adit::intake
