#pragma once

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "icd/members.hpp"

namespace adit::store {

/// The members of a struct in a record, as a tuple of pointers to members in byte order. Rooms specialize it
/// for their structs. For a struct that is only written, a function that returns a reference may take a
/// pointer's place.
template <class Of>
inline constexpr auto kMembers = std::tuple();
/// The number of its kMembers: one for each member of the struct, unless a specialization says otherwise.
template <class Of>
inline constexpr std::size_t kMemberCount = icd::count_of_members<Of>();

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
    using Struct = std::remove_const_t<Of>;
    static_assert(std::tuple_size_v<decltype(kMembers<Struct>)> == kMemberCount<Struct>,
                  "a member is not among its kMembers");
    std::apply([&](auto... member) { (walk(each, std::invoke(member, value)), ...); }, kMembers<Struct>);
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
  void operator()(std::string_view& text) { text = consume(number()); }
  void operator()(std::string& text) { text = consume(number()); }
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
  bool is_at_end() const { return left_.empty(); }
  std::string_view remaining() const { return left_; }

 private:
  std::uint64_t number();
  std::string_view consume(std::size_t size);

  std::string_view left_;
  bool ok_ = true;
};

/// Reads a struct with at least its first `oldest` members, of an earlier version. Others keep their values.
template <std::size_t oldest, class Of>
void read_first_members(auto& take, Of& value) {
  std::size_t place = 0;
  const auto read = [&](auto member) {
    if (place++ < oldest || !take.is_at_end()) walk(take, std::invoke(member, value));
  };
  std::apply([&read](auto... member) { (read(member), ...); }, kMembers<Of>);
}

/// The bytes of these values in sequence.
template <class Put = Writer, class... Of>
std::string bytes_of(const Of&... values) {
  Put put;
  (walk(put, values), ...);
  return put.finish();
}

/// Reads values of bytes_of(). False, with undefined values, if one is missing or wrong, or bytes are left.
template <class ReaderType = Reader, class... Of>
bool read(std::string_view bytes, Of&... values) {
  ReaderType take(bytes);
  (walk(take, values), ...);
  return take.ok() && take.is_at_end();
}

/// Largest body of a record, in bytes.
inline constexpr std::size_t kMostBody = 16u << 20;
/// Kinds of the log's own frames. Users' kinds are 1 to 126, and these with kMustUnderstand.
inline constexpr std::uint8_t kFileBegins = 0, kSnapshotEnds = 127;
/// Flag of a kind: a version that does not know the kind must not use the log.
inline constexpr std::uint8_t kMustUnderstand = 0x80;

/// Placement of frames in a file.
struct Layout {
  std::size_t align = 8;   // frames begin at multiples of it
  std::size_t copies = 1;  // adjacent copies of each frame: 1 or 2
};
/// On disk. A power cut tears whole sectors, so two frames never share a sector.
inline constexpr Layout kOnDisk{4096, 2};
/// In memory, where only a kill interrupts a write.
inline constexpr Layout kInMemory{8, 1};

/// A record in a file (README.md, "A frame").
struct Frame {
  std::uint8_t kind = 0;
  std::uint64_t sequence = 0;  // of the record in the log: 1, 2, 3 ...
  std::uint64_t process = 0;   // of the writing process, higher than all before
  std::uint64_t durable = 0;   // highest sequence number synced when the frame was written
  std::string_view body = {};
};

/// Bytes from the start of a copy to the next start.
std::size_t room_of(std::size_t body, const Layout& layout);

/// All copies of a frame at `offset` of the file with this salt.
std::string to_bytes(const Frame& frame, const Layout& layout, std::uint64_t salt, std::size_t offset);

struct ParsedFrame {
  Frame frame;       // its body refers to the file's bytes
  std::size_t copy;  // 0 or 1
};
/// The frame at `offset`, or std::nullopt if it is absent or damaged.
std::optional<ParsedFrame> parse(std::string_view file, std::size_t offset, std::uint64_t salt);

/// The first place for a frame from `offset` on, a multiple of layout.align; else the file's size.
std::size_t next_candidate(std::string_view file, std::size_t offset, const Layout& layout);

/// A file with one value, its kMembers in a frame with salt 0: no part of it comes from a peer.
template <class Of>
std::string file_of(const Of& value, const Layout& layout) {
  const std::string body = bytes_of(value);
  return to_bytes({.kind = 1, .body = body}, layout, 0, 0);
}
/// The value of file_of() from the copy at `offset`, or std::nullopt if the copy is absent or damaged. A
/// later version may have added members.
template <class Of>
std::optional<Of> value_in(std::string_view file, std::size_t offset = 0) {
  const auto parsed = parse(file, offset, 0);
  if (!parsed || parsed->frame.kind != 1) return std::nullopt;
  Reader take(parsed->frame.body);
  const Of value = take.read<Of>();
  return take.ok() ? std::optional(value) : std::nullopt;
}

/// Appends `number` in `bytes` bytes, little-endian.
void put_number(std::string& out, std::uint64_t number, std::size_t bytes);
/// The little-endian number of `size` bytes at `at`, which must exist.
std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t size);

}  // namespace adit::store
