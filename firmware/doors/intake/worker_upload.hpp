#pragma once

#include <memory>
#include <utility>

#include "intake/upload.hpp"
#include "intake/upload_budget.hpp"
#include "intake/visit.hpp"

namespace adit::intake {

/// An upload that a worker decodes.
class WorkerUpload : public Upload {
 public:
  /// The loop's part. It outlives the upload while a worker runs.
  class Taking {
   public:
    Taking(Visit visit, std::shared_ptr<UploadBudget> budget)
        : visit_(std::move(visit)), share_(std::move(budget), visit_.sender.address) {
      visit_.sender.bytes = 0;
    }
    virtual ~Taking() = default;
    Taking(const Taking&) = delete;
    Taking& operator=(const Taking&) = delete;

    /// As BodySink::on_body().
    virtual bool take(std::span<const std::uint8_t> piece) = 0;
    virtual void whole() = 0;
    void abandon() {
      over_ = true;
      let_go();
    }
    void turn_away(const icd::Refusal& refusal) {
      if (over_) return;
      abandon();
      visit_.refuse(refusal);
    }

   protected:
    /// Rejects the message after the last step has failed, even if the desk has it.
    void fail(const icd::Refusal& refusal) {
      abandon();
      visit_.refuse(refusal);
    }

    Visit visit_;
    UploadShare share_;
    bool over_ = false;  // answered, the client is gone, or the desk has it

   private:
    /// Frees the held parts of the body.
    virtual void let_go() = 0;
  };

  WorkerUpload(const Visit& visit, std::shared_ptr<Taking> taking)
      : Upload(visit), taking_(std::move(taking)) {}
  ~WorkerUpload() override { taking_->abandon(); }
  WorkerUpload(const WorkerUpload&) = delete;
  WorkerUpload& operator=(const WorkerUpload&) = delete;

  bool on_body(std::span<const std::uint8_t> piece) final { return taking_->take(piece); }
  void on_end() final { taking_->whole(); }
  void on_gone() final { taking_->abandon(); }
  void turn_away(const icd::Refusal& refusal) final { taking_->turn_away(refusal); }

 private:
  std::shared_ptr<Taking> taking_;
};

}  // namespace adit::intake
