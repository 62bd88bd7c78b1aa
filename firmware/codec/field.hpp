#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "codec/value.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"

namespace adit::codec {

/// One pass over a document. It keeps the first refusal, so that a reader can be written as the ICD lists a
/// message, and be asked once, at the end, whether all was well.
class Reading {
 public:
  bool refused() const { return refusal_.has_value(); }
  void refuse(icd::Refusal refusal) {
    if (!refusal_) refusal_ = std::move(refusal);
  }
  void keep(icd::Checked<void> checked) {
    if (!checked) refuse(std::move(checked.error()));
  }

  /// `message`, unless anything was refused on the way to it.
  template <class Message>
  icd::Checked<Message> outcome(Message message) {
    if (refusal_) return std::unexpected(*std::move(refusal_));
    return message;
  }

 private:
  std::optional<icd::Refusal> refusal_;
};

/// A value in a document and the way to it, or the place where one could be. Reading a field that is not what
/// is asked for refuses, with a sentence that names it by its path, and gives something harmless.
///
/// A Field points to the Field it came from, which must outlive it. Its path becomes text only in a refusal.
class Field {
 public:
  /// The whole body.
  Field(const Value& root, Reading& reading) : Field(&root, nullptr, {}, 0, reading) {}
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;
  ~Field() = default;

  /// A member of an object. Refuses where this is missing or no object, or has the member twice (RFC 8259 4
  /// leaves open which one would count).
  Field member(std::string_view name) const&;
  Field member(std::string_view name) const&& = delete;

  /// How many elements an array has; an absent one is refused.
  std::size_t size() const;
  /// Requires index < size(). What is refused of it goes to `reading`.
  Field element(std::size_t index, Reading& reading) const&;
  Field element(std::size_t index) const& { return element(index, reading_); }
  Field element(std::size_t index, Reading& reading) const&& = delete;
  Field element(std::size_t index) const&& = delete;

  /// List::reals() of an element of an array that is left as text; false of any other array.
  bool reals(std::size_t index, std::span<const std::string_view> names, std::span<double> into) const;

  /// What is there; null where nothing is given. For readers that tell more than one refusal.
  const Value* value() const { return value_; }

  /// Not given, or null.
  bool is_absent() const;
  template <class Kind>
  bool is() const {
    return value_ && std::holds_alternative<Kind>(value_->is);
  }

  /// A finite number from `least` to `most`; whole numbers are numbers too.
  double number(double least = -kNoLimit, double most = kNoLimit) const;
  /// The same for a float32 of ROS. If float32's rounding moved the number past a limit, it becomes the
  /// limit.
  double float32(double least, double most) const;

  /// A whole number from `least` to `most`; 80.0 is one too.
  template <class Integer>
  Integer whole(Integer least = std::numeric_limits<Integer>::min(),
                Integer most = std::numeric_limits<Integer>::max()) const {
    return static_cast<Integer>(whole_number(least, most));
  }

  /// A string without NUL characters. In CBOR a byte string of UTF-8 is one too: so Python 2 writes text.
  std::string_view text() const;
  /// A string, or such a byte string, without characters.
  bool is_empty_text() const { return characters() == std::string_view(); }
  /// A bool; 0 and 1 are tolerated.
  bool truth() const;
  /// Seconds from 0 to `most`, the last double before a whole number of them: a number, or an object as
  /// ROS 1 and ROS 2 have them: {secs, nsecs}, {sec, nanosec} or {sec, nsec}.
  double seconds(double most) const;

  /// 422 about this field.
  template <class... Parts>
  void refuse(const Parts&... parts) const {
    if (!reading_.refused()) reading_.refuse(icd::unprocessable(path(), ": ", parts...).error());
  }
  /// The same, if the setting `key` can prevent it: a literal, or "".
  template <class... Parts>
  void refuse_by_setting(std::string_view key, const Parts&... parts) const {
    if (!reading_.refused())
      reading_.refuse(icd::unprocessable_by_setting(key, path(), ": ", parts...).error());
  }
  /// "expected ..., got a string", or "missing".
  void refuse_kind(std::string_view expected) const;

  std::string path() const;
  Reading& reading() const { return reading_; }

 private:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  Field(const Value* value, const Field* parent, std::string_view name, std::size_t index, Reading& reading)
      : value_(value), parent_(parent), name_(name), index_(index), reading_(reading) {}
  /// Of an element that is its own.
  Field(std::unique_ptr<const Value> own, const Field* parent, std::size_t index, Reading& reading)
      : own_(std::move(own)), value_(own_.get()), parent_(parent), index_(index), reading_(reading) {}

  std::optional<std::string_view> characters() const;
  std::int64_t whole_number(std::int64_t least, std::int64_t most) const;
  const Value::Object* object() const;

  std::unique_ptr<const Value> own_;  // null: it lies in the document
  const Value* value_;                // null: not given
  const Field* parent_;
  std::string_view name_;  // empty: an element
  std::size_t index_;
  Reading& reading_;
};

}  // namespace adit::codec
