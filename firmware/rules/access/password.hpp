#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace adit::access {

/// Length of the code that sets the first password. It is on the box's label or its console.
inline constexpr std::size_t kCodeDigits = 8;
bool is_code(std::string_view text);
/// In the state directory: the code that was drawn or imported from a card, until a password is set.
inline constexpr const char* kCodeFile = "first-start.code";
/// Digits from 64 random bits.
std::string code_from(std::uint64_t random);

inline constexpr std::size_t kShortest = 10, kLongest = 128;  // characters
inline constexpr std::size_t kMostBytes = 511;                // libcrypt's limit (crypt(3))

/// An error says why it may not become a password. `password` is UTF-8.
std::expected<void, std::string> check_new(std::string_view password);

/// Random bytes, new for each hash.
using Salt = std::array<std::uint8_t, 16>;

/// yescrypt at Debian's cost ("$y$j9T$...", crypt(5)). Takes tens of milliseconds and 16 MiB, so call it on a
/// worker. An error if libcrypt fails, for example for lack of memory.
std::expected<std::string, std::string> hash(const std::string& password, const Salt& salt);

/// True if `hash` was made from this password. Takes as long as hash(), so call it on a worker.
bool matches(const std::string& password, const std::string& hash);

}  // namespace adit::access
