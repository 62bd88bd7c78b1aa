#include "api/update_routes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "api/after.hpp"
#include "api/answers.hpp"

namespace adit::api {
namespace {

/// Streams a body to an Upload.
class Receiving final : public intake::BodySink {
 public:
  Receiving(std::unique_ptr<Upload> upload, std::uint64_t size, std::function<void(icd::Checked<void>)> done)
      : upload_(std::move(upload)), size_(size), done_(std::move(done)) {}
  bool on_body(std::span<const std::uint8_t> piece) override {
    if (!upload_) return true;
    const bool known = head_.size() >= update::kBundleHead;
    if (!known) {
      const std::size_t more = std::min(piece.size(), update::kBundleHead - head_.size());
      head_.insert(head_.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(more));
      if (head_.size() >= update::kBundleHead && !may_be_a_bundle()) return true;
    }
    return upload_->write(piece);
  }
  void on_end() override {
    const bool known = head_.size() >= update::kBundleHead;
    if (upload_ && (known || may_be_a_bundle())) upload_->finish(std::move(done_));
  }
  void on_gone() override { upload_.reset(); }

 private:
  /// False: rejected, and the rest is discarded.
  bool may_be_a_bundle() {
    const std::string why = update::not_a_bundle(head_, size_);
    if (why.empty()) return true;
    upload_.reset();
    done_(icd::unprocessable(why));
    return false;
  }

  std::unique_ptr<Upload> upload_;  // null: rejected
  std::uint64_t size_;
  std::vector<std::uint8_t> head_;
  std::function<void(icd::Checked<void>)> done_;
};

}  // namespace

std::unique_ptr<intake::BodySink> update_routes::receive(Updates& updates, const Call& call) {
  const auto refuse = [&call](intake::Answer answer) {
    call.responder->answer(std::move(answer));
    return nullptr;
  };
  const auto unprocessable = [](std::string_view why) {
    return refusal(icd::Status::UnprocessableEntity, why);
  };
  const auto size = call.head.content_length();
  if (!size || *size == 0) return refuse(unprocessable("Content-Length: expected the bundle's size"));
  const std::string_view again = call.head.query("again");
  if (!again.empty() && again != "0" && again != "1") return refuse(unprocessable("again: expected 0 or 1"));
  auto upload = updates.receive(*size, again == "1", [flow = call.flow] { flow->resume(); });
  if (!upload) return refuse(refused(upload.error()));
  return std::make_unique<Receiving>(std::move(*upload), *size,
                                     [&updates, responder = call.responder](const icd::Checked<void>& done) {
                                       responder->answer(after(updates, done));
                                     });
}

}  // namespace adit::api
