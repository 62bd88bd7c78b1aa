#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace adit::spare {

/// Digits of an export's code, which the exporting box draws. 16 digits are as hard to guess as a strong
/// password (2^53) and can be typed with gloves.
inline constexpr std::size_t kCodeDigits = 16;

/// `random`: from the kernel.
std::string draw_code(const std::array<std::uint8_t, kCodeDigits>& random);

/// "1234 5678 9012 3456", for people.
std::string code_text(std::string_view code);

/// std::nullopt unless the text has 16 digits, with blanks and hyphens anywhere between them.
std::optional<std::string> code_in(std::string_view typed);

/// Largest export, in bytes.
inline constexpr std::size_t kLargestExport = 8u << 20;
/// Bytes of a file beside its content, at most.
inline constexpr std::size_t kSealing = 128;
/// First bytes that identify an export.
inline constexpr std::size_t kExportHead = 12;

/// Random bytes of the kernel, new for each export.
struct Seed {
  std::array<std::uint8_t, 16> salt{};
  std::array<std::uint8_t, 24> nonce{};
};

/// Seals `content`, so that reading it needs the code and any change is detected. Argon2id (32 MiB, 3 passes,
/// about 0.1 s) makes the key from the code; XChaCha20-Poly1305 (libsodium) seals the whole file. Worker
/// thread. Error: out of memory.
std::expected<std::string, std::string> seal(std::string_view content, std::string_view code,
                                             const Seed& seed);

/// The content of a file. Worker thread. Errors: no export, a later Adit's, truncated, changed, wrong code.
std::expected<std::string, std::string> unseal(std::string_view file, std::string_view code);

/// Why a file is no readable export, or "". `file`: the first kExportHead bytes, or all of a shorter file.
std::string export_error(std::string_view file);

}  // namespace adit::spare
