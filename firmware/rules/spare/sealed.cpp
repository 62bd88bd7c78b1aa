#include "spare/sealed.hpp"

#include <sodium.h>

#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::spare {
namespace {

constexpr std::size_t kGroup = 4;

// Format: magic, version byte, zero, salt, nonce, sealed content, and a tag that authenticates them all.
constexpr std::string_view kMagic = "adit-spare";
constexpr std::uint8_t kVersion = 1;
static_assert(kMagic.size() + 2 == kExportHead);
constexpr std::size_t kSalt = crypto_pwhash_SALTBYTES, kNonce = crypto_aead_xchacha20poly1305_ietf_NPUBBYTES,
                      kTag = crypto_aead_xchacha20poly1305_ietf_ABYTES;
constexpr std::size_t kBefore = kExportHead + kSalt + kNonce;
static_assert(kBefore + kTag <= kSealing);
static_assert(sizeof(Seed::salt) == kSalt && sizeof(Seed::nonce) == kNonce);
constexpr std::size_t kMemory = 32u << 20;
constexpr unsigned long long kPasses = 3;

using Key = std::array<std::uint8_t, crypto_aead_xchacha20poly1305_ietf_KEYBYTES>;

const std::uint8_t* bytes(std::string_view text) {
  return reinterpret_cast<const std::uint8_t*>(text.data());
}

std::expected<Key, std::string> key_of(std::string_view code, const std::uint8_t* salt) {
  Key key;
  if (sodium_init() < 0 || crypto_pwhash(key.data(), key.size(), code.data(), code.size(), salt, kPasses,
                                         kMemory, crypto_pwhash_ALG_ARGON2ID13) != 0)
    return std::unexpected("there is not enough memory for the key of the export");
  return key;
}

}  // namespace

std::string draw_code(const std::array<std::uint8_t, kCodeDigits>& random) {
  // The low decimal digits of a number of 128 bits. Their probabilities differ by less than 1 in 2^70.
  std::array<std::uint8_t, kCodeDigits> number = random;
  std::string code;
  for (std::size_t i = 0; i < kCodeDigits; ++i) {
    unsigned rest = 0;
    for (std::uint8_t& byte : number) {
      rest = rest << 8 | byte;
      byte = static_cast<std::uint8_t>(rest / 10);
      rest %= 10;
    }
    code += static_cast<char>('0' + rest);
  }
  return code;
}

std::string code_text(std::string_view code) {
  std::string text;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (i != 0 && i % kGroup == 0) text += ' ';
    text += code[i];
  }
  return text;
}

std::optional<std::string> code_in(std::string_view typed) {
  std::string code;
  for (const char each : typed) {
    if (each == ' ' || each == '-') continue;
    if (each < '0' || each > '9' || code.size() == kCodeDigits) return std::nullopt;
    code += each;
  }
  if (code.size() != kCodeDigits) return std::nullopt;
  return code;
}

std::expected<std::string, std::string> seal(std::string_view content, std::string_view code,
                                             const Seed& seed) {
  auto key = ADIT_TRY(key_of(code, seed.salt.data()));
  std::string file(kMagic);
  file += static_cast<char>(kVersion);
  file += '\0';
  file.append(reinterpret_cast<const char*>(seed.salt.data()), kSalt);
  file.append(reinterpret_cast<const char*>(seed.nonce.data()), kNonce);
  file.resize(kBefore + content.size() + kTag);
  auto* const data = reinterpret_cast<std::uint8_t*>(file.data());
  crypto_aead_xchacha20poly1305_ietf_encrypt(data + kBefore, nullptr, bytes(content), content.size(), data,
                                             kBefore, nullptr, seed.nonce.data(), key.data());
  sodium_memzero(key.data(), key.size());
  return file;
}

std::string export_error(std::string_view file) {
  if (file.size() < kExportHead || !file.starts_with(kMagic)) return "the file is not an export from Adit";
  const auto version = static_cast<std::uint8_t>(file[kMagic.size()]);
  if (version > kVersion)
    return icd::sentence("a later Adit made this export (version ", int{version}, ", this box reads ",
                         int{kVersion}, "): update this box first");
  if (version < 1 || file[kMagic.size() + 1] != '\0') return "the file is not an export from Adit";
  return "";
}

std::expected<std::string, std::string> unseal(std::string_view file, std::string_view code) {
  if (std::string why = export_error(file); !why.empty()) return std::unexpected(std::move(why));
  if (file.size() > kLargestExport) return std::unexpected("the file is larger than an export may be");
  if (file.size() < kBefore + kTag) return std::unexpected("the export is incomplete");
  const auto* const data = bytes(file);
  auto key = ADIT_TRY(key_of(code, data + kExportHead));
  std::string content(file.size() - kBefore - kTag, '\0');
  const int opened = crypto_aead_xchacha20poly1305_ietf_decrypt(
      reinterpret_cast<std::uint8_t*>(content.data()), nullptr, nullptr, data + kBefore,
      file.size() - kBefore, data, kBefore, data + kExportHead + kSalt, key.data());
  sodium_memzero(key.data(), key.size());
  if (opened != 0) return std::unexpected("the code is not that of this export, or the export is damaged");
  return content;
}

}  // namespace adit::spare
