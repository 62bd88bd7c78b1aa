#pragma once

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

namespace adit::store {

/// The members of a struct in a record, as a tuple of pointers to members in byte order. Rooms specialize it
/// for their structs. For a struct that is only written, a function that returns a reference may take a
/// pointer's place.
template <class Of>
inline constexpr auto kMembers = std::tuple();

/// Calls `each` with the plain values in `value`, in order. A struct has its kMembers. An optional has a
/// flag, then its value or a default one. A list has its size, then its items. Pairs, tuples and arrays have
/// their items. A value is plain if `each` has an overload for it. A const `value` is written; others are
/// read, and ok() reports the result.
template <class Of>
void walk(auto& each, Of& value) {
  if constexpr (requires { each(value); }) {
    each(value);
  } else if constexpr (requires { value.has_value(); }) {
    bool is_there = value.has_value();
    each(is_there);
    if constexpr (std::is_const_v<Of>) {
      const typename Of::value_type absent{};
      walk(each, is_there ? *value : absent);
    } else {
      walk(each, value.emplace());
      if (!is_there) value.reset();
    }
  } else if constexpr (requires { std::tuple_size<Of>(); }) {
    std::apply([&each](auto&... items) { (walk(each, items), ...); }, value);
  } else if constexpr (requires { value.size(); }) {
    std::size_t count = value.size();
    each(count);
    if constexpr (std::is_const_v<Of>) {
      for (const auto& item : value) walk(each, item);
    } else {
      for (value.clear(); count > 0 && each.ok(); --count) walk(each, value.emplace_back());
    }
  } else {
    static_assert(std::tuple_size_v<decltype(kMembers<std::remove_const_t<Of>>)> > 0, "specialize kMembers");
    std::apply([&](auto... member) { (walk(each, std::invoke(member, value)), ...); },
               kMembers<std::remove_const_t<Of>>);
  }
}

/// Writes plain values in sequence: numbers in 8 bytes, little-endian; reals as IEEE 754 doubles; texts after
/// their sizes.
class Writer {
 public:
  void operator()(std::uint64_t number);
  void operator()(std::integral auto number) { (*this)(static_cast<std::uint64_t>(number)); }
  template <class Word>
    requires std::is_enum_v<Word>
  void operator()(Word word) {
    (*this)(std::to_underlying(word));
  }
  void operator()(double real);
  void operator()(std::string_view text);
  void operator()(std::chrono::nanoseconds time) { (*this)(time.count()); }
  void operator()(std::chrono::steady_clock::time_point at) { (*this)(at.time_since_epoch()); }
  std::string finish() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads a Writer's bytes. Beyond their end, values read as 0 or "". Then, or if a number does not fit its
/// type, ok() is false from then on.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}

  template <std::integral Whole>
  void operator()(Whole& number) {
    const std::uint64_t read = this->number();
    number = static_cast<Whole>(read);
    check(static_cast<std::uint64_t>(number) == read);
  }
  template <class Word>
    requires std::is_enum_v<Word>
  void operator()(Word& word) {
    std::underlying_type_t<Word> number{};
    (*this)(number);
    word = static_cast<Word>(number);
  }
  void operator()(double& real);
  void operator()(std::string_view& text) { text = take(number()); }
  void operator()(std::string& text) { text = take(number()); }
  void operator()(std::chrono::nanoseconds& time) { time = std::chrono::nanoseconds(read<std::int64_t>()); }
  void operator()(std::chrono::steady_clock::time_point& at) {
    at = std::chrono::steady_clock::time_point(read<std::chrono::nanoseconds>());
  }
  /// The next value, of any type that walk() supports.
  template <class Of>
  Of read() {
    Of value{};
    walk(*this, value);
    return value;
  }

  /// Makes ok() false from now on unless `is_good`.
  void check(bool is_good) { ok_ = ok_ && is_good; }
  bool ok() const { return ok_; }
  bool at_end() const { return left_.empty(); }
  std::string_view left() const { return left_; }

 private:
  std::uint64_t number();
  std::string_view take(std::size_t size);

  std::string_view left_;
  bool ok_ = true;
};

/// The bytes of these values in sequence.
template <class Put = Writer, class... Of>
std::string bytes_of(const Of&... values) {
  Put put;
  (walk(put, values), ...);
  return put.finish();
}

/// Reads values that bytes_of() wrote. False, with undefined values, if one is missing or wrong, or bytes are
/// left.
template <class Take = Reader, class... Of>
bool read(std::string_view bytes, Of&... values) {
  Take take(bytes);
  (walk(take, values), ...);
  return take.ok() && take.at_end();
}

}  // namespace adit::store
