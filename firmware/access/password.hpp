#pragma once

#include <array>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace adit::access {

/// What the first password is set with: 8 digits, on the box's label or on its console.
inline constexpr std::size_t kCodeDigits = 8;
bool is_code(std::string_view text);
/// In the state folder: the code that was drawn, or brought by a card, until a password is set.
inline constexpr const char* kCodeFile = "first-start.code";
/// From 64 random bits.
std::string code_from(std::uint64_t random);

inline constexpr std::size_t kShortest = 10, kLongest = 128;  // characters
inline constexpr std::size_t kMostBytes = 511;                // libcrypt's limit (crypt(3))

/// Whether it may become a password, or a sentence why not. `password` is UTF-8.
std::expected<void, std::string> check_new(std::string_view password);

/// Random bytes, new for each hash.
using Salt = std::array<std::uint8_t, 16>;

/// yescrypt at Debian's cost ("$y$j9T$...", crypt(5)): tens of milliseconds and 16 MiB, so on a worker. An
/// error where there is no memory for it.
std::expected<std::string, std::string> hash(const std::string& password, const Salt& salt);

/// Whether `hash` was made of it: takes as long as hash(). For a worker.
bool matches(const std::string& password, const std::string& hash);

}  // namespace adit::access
