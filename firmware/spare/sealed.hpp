#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

namespace adit::spare {

/// The largest export that is written or read, in bytes.
inline constexpr std::size_t kLargestExport = 8u << 20;
/// What a file has beside its content, at most.
inline constexpr std::size_t kSealing = 128;
/// By so many of its first bytes a file is told from what is no export.
inline constexpr std::size_t kExportHead = 12;

/// Of the kernel's randomness, new for each export.
struct Seed {
  std::array<std::uint8_t, 16> salt{};
  std::array<std::uint8_t, 24> nonce{};
};

/// `content` as a file that only who has the code can read, and that nobody can change unseen: the key is
/// made from the code by Argon2id (32 MiB, 3 passes: about 0.1 s), the file is sealed as a whole by
/// XChaCha20-Poly1305 (libsodium). For a worker. An error: there is no memory for it.
std::expected<std::string, std::string> seal(std::string_view content, std::string_view code,
                                             const Seed& seed);

/// The content of a whole file. For a worker. An error is a sentence: it is no export, a later Adit's, cut
/// off or changed, or the code is another's.
std::expected<std::string, std::string> unseal(std::string_view file, std::string_view code);

/// Why a file that begins so is no export that can be read here; "": it may be one. Of at least kExportHead
/// bytes, or the whole of a shorter file.
std::string not_an_export(std::string_view head);

}  // namespace adit::spare
