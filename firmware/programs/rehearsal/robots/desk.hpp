#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <set>
#include <stop_token>
#include <string>

#include "rehearsal/robots/client.hpp"

namespace adit::robots {

/// The operator's desk: takes what robots found, once for each artifact, and submits it, one report after
/// another, while the robots go on. Also asks for the run's status now and then.
class OperatorDesk {
 public:
  /// `say` prints a line; `style` and `tally` outlive the desk.
  /// Asks for the status in `style`.
  OperatorDesk(Post post, const Style& style, Tally& tally, std::function<void(const std::string&)> say);

  struct Finding {
    std::string robot;
    const Style* style = nullptr;  // the report goes out as the robot's own software writes it
    Report report;
  };

  /// Whether `artifact` (its number in the cave) is news; from any thread.
  bool is_news(std::size_t artifact);
  void submit(Finding finding);

  /// Works until `finish`, and then waits for the answer that is on its way; gives that up at `abort`.
  void work(const std::stop_token& finish, const std::stop_token& abort);

 private:
  void ask_status(const std::stop_token& abort);
  void report(const Finding& finding, const std::stop_token& finish, const std::stop_token& abort);
  void sleep(std::chrono::milliseconds time, const std::stop_token& stop);
  void tell(const Finding& finding, const std::string& outcome) const;

  Post post_;
  const Style& style_;
  Tally& tally_;
  std::function<void(const std::string&)> say_;

  std::mutex mutex_;  // guards all below
  std::condition_variable_any changed_;
  std::deque<Finding> waiting_;
  std::set<std::size_t> known_;
};

}  // namespace adit::robots
