#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/value.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// One pass over a document. Stores the first refusal, so that a reader can follow the ICD's listing and
/// check once at the end. If that is a missing member, the refusal names all that are missing.
class Reading {
 public:
  bool has_refusal() const { return refusal_.has_value(); }
  void refuse(icd::Refusal refusal) {
    if (!refusal_) refusal_ = std::move(refusal);
  }
  /// 422: the member at `path` is missing. `hint`: its likely place, or "".
  void miss(const std::string& path, std::string_view hint);
  void keep(icd::Checked<void> checked) {
    if (!checked) refuse(std::move(checked.error()));
  }

  /// `message`, or the stored refusal.
  template <class Message>
  icd::Checked<Message> outcome(Message message) {
    if (refusal_) return std::unexpected(*std::move(refusal_));
    return message;
  }

 private:
  std::optional<icd::Refusal> refusal_;
  std::vector<std::string> missing_;  // paths; empty: the refusal is about another fault
  std::string hint_;
};

/// A value in a document and its path, or the place of an absent value. Reading a field of another kind
/// refuses with a sentence that names its path, and returns a harmless value.
///
/// A Field refers to its parent Field, which must outlive it. The path becomes text only in a refusal.
class Field {
 public:
  /// The whole body.
  Field(const Value& root, Reading& reading) : Field(&root, nullptr, {}, 0, reading) {}
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  ~Field() = default;

  /// Refuses if this is absent, no object, or has the member twice (RFC 8259 4 leaves open which counts).
  Field member(std::string_view name) const&;
  Field member(std::string_view name) const&& = delete;

  /// Number of elements of an array. Refuses if it is absent.
  std::size_t size() const;
  /// Requires index < size(). Refusals go to `reading`.
  Field element(std::size_t index, Reading& reading) const&;
  Field element(std::size_t index) const& { return element(index, reading_); }
  Field element(std::size_t index, Reading& reading) const&& = delete;
  Field element(std::size_t index) const&& = delete;

  /// List::reals() for an element of an array left as text; false for other arrays.
  bool reals(std::size_t index, std::span<const std::string_view> names, std::span<double> into) const;

  /// The value, or null if absent. For readers that report more than one refusal.
  const Value* value() const { return value_; }

  /// Absent or null.
  bool is_absent() const;
  template <class Kind>
  bool is() const {
    return value_ && std::holds_alternative<Kind>(value_->is);
  }

  /// A finite number from `least` to `most`. Whole numbers are allowed.
  double number(double least = -kNoLimit, double most = kNoLimit) const;
  /// The same for a float32 of ROS. If rounding to float32 passes a limit, returns the limit.
  double float32(double least, double most) const;

  /// A whole number from `least` to `most`. 80.0 is allowed.
  template <class Integer>
  Integer integer(Integer least = std::numeric_limits<Integer>::min(),
                  Integer most = std::numeric_limits<Integer>::max()) const {
    return static_cast<Integer>(read_integer(least, most));
  }

  /// A string without NUL. In CBOR a byte string of UTF-8 is allowed, because Python 2 writes text so.
  std::string_view text() const;
  /// Whether it is such a string without characters.
  bool is_empty_text() const { return characters() == std::string_view(); }
  /// A bool; 0 and 1 are allowed.
  bool truth() const;
  /// Seconds from 0 to `most`, the last double before a whole number of seconds. A number, or an object of
  /// ROS 1 or ROS 2: {secs, nsecs}, {sec, nanosec} or {sec, nsec}.
  double seconds(double most) const;

  /// Refuses with 422 about this field.
  template <class... Parts>
  void refuse(const Parts&... parts) const {
    if (!reading_.has_refusal()) reading_.refuse(icd::unprocessable(path(), ": ", parts...).error());
  }
  /// The same with the setting that can prevent it. `key`: a literal or "".
  template <class... Parts>
  void refuse_by_setting(std::string_view key, const Parts&... parts) const {
    if (!reading_.has_refusal())
      reading_.refuse(icd::unprocessable_by_setting(key, path(), ": ", parts...).error());
  }
  /// Refuses with "expected ..., got a string", or "missing".
  void refuse_kind(std::string_view expected) const;

  std::string path() const;
  Reading& reading() const { return reading_; }

 private:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  Field(const Value* value, const Field* parent, std::string_view name, std::size_t index, Reading& reading)
      : value_(value), parent_(parent), name_(name), index_(index), reading_(reading) {}
  Field(std::unique_ptr<const Value> own, const Field* parent, std::size_t index, Reading& reading)
      : own_(std::move(own)), value_(own_.get()), parent_(parent), index_(index), reading_(reading) {}

  std::optional<std::string_view> characters() const;
  /// Refuses an absent value.
  void miss() const;
  std::int64_t read_integer(std::int64_t least, std::int64_t most) const;
  const Value::Object* object() const;

  std::unique_ptr<const Value> own_;  // null: the value is in the document
  const Value* value_;                // null: absent
  const Field* parent_;
  std::string_view name_;  // empty: an element
  std::size_t index_;
  Reading& reading_;
};

}  // namespace adit::codec
