#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dispatch/run.hpp"

namespace adit::dispatch {

/// All runs that Adit has seen, and which is the present one. None is ever forgotten: a run is taken up again
/// where its Command Post is back.
class Runs {
 public:
  /// `latest`: the highest number of a run that a report belongs to; the report may have been written down
  /// before its run was.
  void open(std::vector<Run> all, std::int64_t latest);

  const Run& present() const { return runs_.at(present_); }
  Run& present() { return runs_.at(present_); }
  const Run* find(std::int64_t number) const;
  const std::map<std::int64_t, Run>& all() const { return runs_; }

  /// Of those that fit, the one that was the present one last, but not now; nothing: none fits.
  const Run* latest(const std::function<bool(const Run&)>& fits) const;
  /// The latest() at `post`: it is taken up again where the settings name that Command Post.
  const Run* at_post(const std::string& post) const;
  /// The number of the run that begins next.
  std::int64_t next_number() const { return runs_.rbegin()->first + 1; }
  /// It is the present one from now on; its number and turn are given to it.
  void begin(Run run);
  /// An earlier one is the present one again.
  void take_up(std::int64_t number);

  /// `number` is a run at `post`; one that is not known counts as being there.
  bool is_at(std::int64_t number, const std::string& post) const;
  /// It is at the present run's Command Post.
  bool is_here(std::int64_t number) const { return is_at(number, present().post); }
  /// The present run, the run that it may still be, the run that that one may be, and so on.
  std::vector<std::int64_t> maybe_present() const;
  /// `number` is one of maybe_present(), but not the present run.
  bool may_be_present(std::int64_t number) const;
  /// The present run is not `number`, which may_be_present(). Returns the run in which another run began.
  const Run& is_not(std::int64_t number);

 private:
  std::int64_t next_turn() const;

  std::map<std::int64_t, Run> runs_{{1, Run{}}};
  std::int64_t present_ = 1;
};

}  // namespace adit::dispatch
