#pragma once

#include <optional>
#include <string>
#include <vector>

#include "intake/field_text.hpp"
#include "intake/server.hpp"
#include "intake/target.hpp"

namespace adit::intake {

/// The parts of a head that HeadChecker has found whole.
struct HeadParts {
  std::string_view method, target;
  std::string_view fields;  // the lines of the fields
};
HeadParts parts_of(std::string_view head);

/// The head of a request.
class Head final : public RequestHead {
 public:
  /// `text`: a head that HeadChecker has found whole. `target`: its target.
  Head(std::string text, Target target, const std::string& peer, const std::string& local,
       std::optional<std::uint64_t> length);
  Head(const Head&) = delete;
  Head& operator=(const Head&) = delete;

  std::string_view method() const override { return method_; }
  std::string_view path() const override { return target_.path; }
  std::string_view query(std::string_view name) const override;
  std::string_view header(std::string_view name) const override;
  std::optional<std::uint64_t> content_length() const override { return length_; }
  const std::string& peer() const override { return peer_; }
  const std::string& local() const override { return local_; }

 private:
  std::string text_;
  std::string_view method_;  // this and fields_ are in text_
  std::vector<FieldLine> fields_;
  Target target_;
  const std::string& peer_;
  const std::string& local_;
  std::optional<std::uint64_t> length_;
};

}  // namespace adit::intake
