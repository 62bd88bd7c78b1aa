#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "icd/status.hpp"
#include "intake/visit.hpp"

namespace adit::intake {

/// The most values of a small document (codec::Limits): 25 MiB at worst.
inline constexpr std::size_t kSmallValues = 100'000;

/// Receives the body of a message. It can be rejected before the body is whole.
class Upload : public BodySink {
 public:
  explicit Upload(const Visit& visit)
      : uploads_(visit.uploads), uri_(visit.uri), address_(visit.sender.address), began_(visit.sender.began) {
    uploads_->under_way.insert(this);
  }
  ~Upload() override { uploads_->under_way.erase(this); }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// Rejects the message, unless the desk has it and will answer it.
  virtual void turn_away(const icd::Refusal& refusal) = 0;

  /// Whether it is of the same address and URI.
  bool is_like(const Visit& visit) const { return uri_ == visit.uri && address_ == visit.sender.address; }
  std::uint64_t began() const { return began_; }

 private:
  std::shared_ptr<Uploads> uploads_;
  icd::Uri uri_;
  std::string address_;
  std::uint64_t began_;
};

}  // namespace adit::intake
