#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <queue>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "dispatch/model/command_post.hpp"
#include "dispatch/model/disk.hpp"
#include "dispatch/reports.hpp"

namespace adit::dispatch::model {

/// Probabilities of faults.
struct Trouble {
  double answer_lost = 0;   // recorded, but its answer is lost
  double request_lost = 0;  // neither recorded nor answered
  double late = 0;          // recorded after Adit has stopped waiting
  double never_left = 0, throttled = 0, barred = 0, refused = 0;
  double server_error = 0;  // half of them after recording
  double status_fails = 0;
  double power_cut = 0;  // before or after each write; a tenth at any other event
  double disk_full = 0;  // for some seconds
  bool other_sender = false, admin_stops = false, new_runs = false;
  CommandPost::Clocks clocks = CommandPost::Clocks::Running;
  bool one_name = false;       // for all runs
  bool courses = false;        // the settings switch between two Command Posts and an absent one
  bool operator_acts = false;  // the operator also declares new runs early
  Review review = Review::Off;
};

/// Counts that show that a test is not vacuous.
struct Tally {
  std::int64_t steps = 0, posts = 0, acknowledged = 0, recorded = 0, settled = 0, sent_again = 0,
               power_cuts = 0, undecided = 0, held = 0, held_back = 0, switches = 0;
};

/// Adit's rules, clients, a Command Post and the connection, in simulated time and from one seed.
class World final : public Output {
 public:
  static constexpr double kEpoch = 1.7e9;  // simulated time 0, as a stamp

  World(const Trouble& trouble, std::uint64_t seed);
  ~World() override;

  /// Ten minutes of faults, then quiet until all reports are final.
  void live();
  /// Violations of promise 1, a sentence each.
  std::vector<std::string> broken_promises() const;
  const Tally& tally() const { return tally_; }
  /// Empty unless ADIT_MODEL_STORY is set.
  const std::string& story() const { return story_; }

 private:
  struct Event {
    Seconds at = 0;
    std::uint64_t order = 0;
    std::int64_t life = 0;  // process start that it belongs to; 0: none
    std::function<void()> happen;
    bool operator<(const Event& other) const { return at != other.at ? at > other.at : order > other.order; }
  };
  struct Posting {
    Seconds at = 0;
    std::size_t place = 0;
    bool heard = false;  // a run was known at that time
  };
  struct Client {
    double key = 0;
    Seconds patience = 20, pause = 1;
    std::int64_t tries_left = 20;
    ClientId waiting = 0;  // the post in flight
    bool done = false, acknowledged = false;
    std::vector<Posting> posted;
  };

  // The oracle (oracle.cpp). Each adds the violations that it finds.
  bool was_recorded(double key) const;
  std::vector<Recorded> recorded() const;
  bool was_meant(const Recorded& record, std::size_t place) const;
  void check_records(std::vector<std::string>& broken) const;
  void check_ledger(std::vector<std::string>& broken) const;
  void check_clients(std::vector<std::string>& broken) const;

  // Output.
  bool write(std::span<const Report> steps, const Run* run, Flush flush) override;
  void answer_client(ClientId client, const ClientAnswer& answer, const Report& report) override;

  // Time.
  void later(Seconds delay, std::function<void()> happen, bool of_process = true);
  void run_until(Seconds end);
  Time time() const;
  double chance() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  void tell_story(const std::string& sentence);

  // The box and its clients.
  void start();
  CommandPost& post() { return posts_there_[std::min(place_, posts_there_.size() - 1)]; }
  bool is_anybody_there() const { return place_ < posts_there_.size(); }
  void post(std::size_t client);
  void heard(std::size_t client, bool done, bool acknowledged);

  // Trouble, and the operator (trouble.cpp).
  void switch_course();
  void cut_power();
  void switch_on();
  void take_operators_word();
  void declare_run();
  void make_trouble();

  // The wire (wire.cpp).
  /// A request that the Command Post has read and will record.
  struct Pending {
    icd::ArtifactReport report;
    CommandPost* post = nullptr;
    Seconds at = 0;
    std::function<void(HttpAnswer)> then;
    bool done = false;
  };
  void pump();
  void transmit(const Report& report);
  void ask();
  void record_later(Seconds delay, const icd::ArtifactReport& report, std::function<void(HttpAnswer)> then);
  void record_at(const std::shared_ptr<Pending>& pending);
  /// Requests that were read are recorded soon.
  void drop_connections();

  const Trouble trouble_;
  std::mt19937_64 random_;
  bool calm_ = false;
  Seconds now_ = 1;
  std::uint64_t order_ = 0;
  std::priority_queue<Event> events_;

  Disk disk_;
  std::vector<CommandPost> posts_there_;  // one per place; the place after the last has no Command Post
  std::size_t place_ = 0;                 // in the settings
  std::unique_ptr<Reports> reports_;
  std::int64_t life_ = 0;
  bool busy_ = false;
  Seconds report_ready_ = 0, status_ready_ = 0, poll_at_ = 0;

  std::vector<std::shared_ptr<Pending>> pending_;

  std::vector<Client> clients_;
  std::map<ClientId, std::size_t> posts_;
  ClientId last_post_ = 0;
  std::optional<Seconds> first_heard_;  // time of the first status on disk
  bool declared_ = false;               // the operator declared a run
  std::set<double> touched_;            // reports that the operator decided
  std::vector<Seconds> others_;         // times of another sender's reports
  std::vector<std::string> broken_;     // violations found during the run
  Tally tally_;
  std::string story_;
  bool tells_ = false;
};

}  // namespace adit::dispatch::model
