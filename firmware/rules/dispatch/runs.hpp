#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dispatch/run.hpp"

namespace adit::dispatch {

/// All runs seen. Adit keeps them, because a run continues when its Command Post returns.
class Runs {
 public:
  /// `latest`: highest run number of a report, which may have been written before its run.
  void open(std::vector<Run> all, std::int64_t latest);

  const Run& present() const { return runs_.at(present_); }
  Run& present() { return runs_.at(present_); }
  /// The run of a report that is posted now: present(), or the run of will_be().
  const Run& meant() const { return runs_.at(will_be_ != 0 ? will_be_ : present_); }
  /// Run `number` will be the present one. 0: no change is due.
  void will_be(std::int64_t number) { will_be_ = number; }
  const Run* find(std::int64_t number) const;
  const std::map<std::int64_t, Run>& all() const { return runs_; }

  /// Of the fitting runs the one that was present last, except the present one; or null.
  const Run* latest(const std::function<bool(const Run&)>& fits) const;
  /// latest() at `post`.
  const Run* at_post(const std::string& post) const;
  std::int64_t next_number() const { return runs_.rbegin()->first + 1; }
  /// Gives it a number and a turn.
  void begin(Run run);
  void take_up(std::int64_t number);

  /// True if run `number` is at `post`. A run that is unknown, or has no address, counts as there.
  bool is_at(std::int64_t number, const std::string& post) const;
  bool is_here(std::int64_t number) const { return is_at(number, present().post); }
  /// The present run, the run that it may still be, the run that that one may be, and so on.
  std::vector<std::int64_t> maybe_present() const { return maybe(present_); }
  /// True if run `number` is `other`, or may still be.
  bool may_be(std::int64_t number, std::int64_t other) const;
  /// Run::name_trouble of the present run, or of one that it may still be. "": names count.
  const std::string& name_trouble() const;
  /// True if `number` is one of maybe_present(), but not the present run.
  bool may_be_present(std::int64_t number) const { return number != present_ && may_be(present_, number); }
  /// The present run is not `number`, which may_be_present(). Returns the run in which another run began.
  const Run& is_not(std::int64_t number);

 private:
  /// maybe_present() for run `number`.
  std::vector<std::int64_t> maybe(std::int64_t number) const;
  std::int64_t next_turn() const;

  std::map<std::int64_t, Run> runs_{{1, Run{}}};
  std::int64_t present_ = 1;
  std::int64_t will_be_ = 0;
};

}  // namespace adit::dispatch
