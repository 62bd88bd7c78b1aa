#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dispatch/output.hpp"
#include "intake/server.hpp"
#include "ledger/ledger.hpp"
#include "loop/loop.hpp"

namespace adit::forward {

/// Writes report steps to the ledger and the log, and answers clients.
class ReportOutput final : public dispatch::Output {
 public:
  /// Delay of work that can follow a sent report or an answered client: Flush::Soon and the log.
  static constexpr std::chrono::milliseconds kSoon{2};
  /// Retry interval while the ledger cannot be written.
  static constexpr std::chrono::seconds kTryEvery{5};

  ReportOutput(loop::Loop& loop, ledger::Ledger& ledger);

  dispatch::ClientId add(std::shared_ptr<intake::Responder> responder);
  /// A client without answers, for the operator, who watches the report.
  dispatch::ClientId add_nobody() { return ++last_client_; }
  /// The last answer to any client.
  const dispatch::ClientAnswer& last_answer() const { return last_told_; }

  bool write(std::span<const dispatch::Report> steps, const dispatch::Run* run,
             dispatch::Flush flush) override;
  void answer_client(dispatch::ClientId client, const dispatch::ClientAnswer& answer,
                     const dispatch::Report& report) override;

  /// Why the last write to the ledger failed, or "".
  const std::string& trouble() const { return trouble_; }

 private:
  /// A step for the log.
  struct Step {
    std::int64_t number;
    std::string type, sender;
    dispatch::ReportState state;
    int status;
    std::string note;
  };
  void follow_up();
  void on_tried(const ledger::Result<void>& result);

  loop::Loop& loop_;
  ledger::Ledger& ledger_;
  loop::Source follow_up_, try_again_;
  std::vector<Step> unlogged_;
  std::map<dispatch::ClientId, std::shared_ptr<intake::Responder>> clients_;
  dispatch::ClientId last_client_ = 0;
  dispatch::ClientAnswer last_told_;
  std::string trouble_;
};

}  // namespace adit::forward
