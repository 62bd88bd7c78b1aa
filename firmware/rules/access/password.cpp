#include "access/password.hpp"

#include <crypt.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "icd/bearer_token.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::access {
namespace {

/// Wipes libcrypt's working memory (32 KiB), because it contains the password.
struct WipingDeleter {
  void operator()(crypt_data* data) const {
    explicit_bzero(data, sizeof *data);
    delete data;
  }
};

/// "" if libcrypt fails.
std::string hash_password(const std::string& password, const std::string& setting) {
  const std::unique_ptr<crypt_data, WipingDeleter> data(new crypt_data{});
  const char* const text = crypt_r(password.c_str(), setting.c_str(), data.get());
  return text == nullptr || *text == '*' ? "" : text;  // "*0": failure (crypt(3))
}

}  // namespace

bool is_code(std::string_view text) {
  return text.size() == kCodeDigits && std::ranges::all_of(text, icd::is_digit);
}

std::string code_from(std::uint64_t random) {
  std::string code;
  for (std::size_t i = 0; i < kCodeDigits; ++i, random /= 10) {
    code.push_back(static_cast<char>('0' + random % 10));
  }
  return code;
}

std::expected<void, std::string> check_new(std::string_view password) {
  const std::size_t size = icd::count_characters(password);
  if (size < kShortest || size > kLongest || password.size() > kMostBytes) {
    return std::unexpected(
        icd::sentence("expected ", kShortest, " to ", kLongest, " characters, got ", size));
  }
  const auto is_control = [](unsigned char byte) { return byte < 0x20 || byte == 0x7f; };
  if (std::ranges::any_of(password, is_control)) return std::unexpected("expected no control characters");
  return {};
}

std::expected<std::string, std::string> hash(const std::string& password, const Salt& salt) {
  char setting[CRYPT_GENSALT_OUTPUT_SIZE];
  const auto* const bytes = reinterpret_cast<const char*>(salt.data());
  const char* const made = crypt_gensalt_rn("$y$", 0, bytes, static_cast<int>(salt.size()), setting,
                                            static_cast<int>(sizeof setting));
  std::string text = made == nullptr ? "" : hash_password(password, made);
  if (text.empty()) return std::unexpected("cannot hash the password: there may not be enough memory");
  return text;
}

bool matches(const std::string& password, const std::string& hash) {
  if (password.size() > kMostBytes) return false;
  const auto expected = icd::BearerToken::parse(hash);  // compares in constant time
  return expected && expected->matches(hash_password(password, hash));
}

}  // namespace adit::access
