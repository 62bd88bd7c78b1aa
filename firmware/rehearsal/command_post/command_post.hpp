#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "rehearsal/command_post/judgement.hpp"
#include "rehearsal/command_post/options.hpp"
#include "rehearsal/command_post/record.hpp"
#include "rehearsal/command_post/run.hpp"
#include "rehearsal/command_post/secrets.hpp"
#include "rehearsal/command_post/transcript.hpp"

namespace adit::rehearsal {

/// A whole Command Post, but for its sockets: both endpoints, the run, the record and the transcript. Safe
/// for use by several threads.
class CommandPost {
 public:
  /// `transcript` may be null.
  CommandPost(const Options& options, const Secrets& secrets, std::vector<Artifact> artifacts,
              std::unique_ptr<Transcript> transcript);

  /// Each decides what is done about a request to that endpoint and writes it down, before anything is sent.
  Outcome scoring(const Request& request) { return receive(*scoring_, "scoring", request); }
  Outcome mapping(const Request& request) { return receive(*mapping_, "mapping", request); }

  Run& run() { return run_; }
  OrderedJson record() const { return record_.json(run_.plan(), run_.standing(Clock::now())); }
  std::string summary() const { return record_.summary(run_.plan(), run_.standing(Clock::now())); }
  std::string killed_by() const { return record_.killed_by(); }

 private:
  Outcome receive(Endpoint& endpoint, const char* name, const Request& request);
  void write_down(std::uint64_t number, const char* endpoint, const Request& request, Judgement& judgement);
  void show(std::uint64_t number, const Request& request, const Judgement& judgement) const;

  const Clock::time_point launched_ = Clock::now();
  const bool verbose_;
  Run run_;
  Record record_;
  std::unique_ptr<Endpoint> scoring_;
  std::unique_ptr<Endpoint> mapping_;
  std::unique_ptr<Transcript> transcript_;
  std::mutex number_mutex_;
  std::uint64_t number_;
};

}  // namespace adit::rehearsal
