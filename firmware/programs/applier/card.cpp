#include "applier/card.hpp"

#include <algorithm>
#include <utility>

#include "access/password.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "network/check.hpp"
#include "network/messages.hpp"
#include "settings/saved.hpp"

namespace adit::applier {
namespace {

using host::UntrustedFolder;
using settings::Settings;

/// Reads one card.
class Reader {
 public:
  Reader(const UntrustedFolder& card, const Settings& now) : card_(card), now_(now) {}

  Found read() && {
    read_names();
    read_settings();
    read_network();
    read_secrets();
    return std::move(found_);
  }

 private:
  void refuse(const std::string& name, const std::string& what) {
    found_.errors.push_back(icd::sentence("adit/", host::escaped(name), ": ", host::escaped(what)));
  }
  void refuse(const std::string& name, const std::vector<settings::Error>& errors) {
    for (const settings::Error& error : errors) refuse(name, error.sentence());
  }

  /// The content of a file of `folder`. Errors call the file `name`.
  std::optional<std::string> text_of(const UntrustedFolder& folder, const std::string& file,
                                     const std::string& name) {
    static constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    auto text = folder.read(file);
    if (!text) {
      refuse(name, text.error().substr(std::min(text.error().size(), file.size() + 2)));
      return std::nullopt;
    }
    if (*text && (*text)->starts_with(kByteOrderMark)) (*text)->erase(0, kByteOrderMark.size());
    return std::move(*text);
  }

  void read_names() {
    const auto names = card_.names();
    if (!names) return refuse("", names.error());
    for (const std::string& written : *names) {
      std::string name = written;  // FAT ignores case
      std::ranges::transform(name, name.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter | 0x20) : letter;
      });
      const bool known =
          name == kCardSettings || name == kCardNetwork || name == kCardSecrets || is_spent(name);
      if (!known) found_.left_alone.push_back(written);
    }
  }

  /// Whether the file was accepted before, is Adit's own, or is a desktop's hidden file.
  static bool is_spent(const std::string& name) {
    return name.starts_with('.') || name.ends_with(kTakenEnding) || name == kTakenText;
  }

  void read_settings() {
    const auto text = text_of(card_, kCardSettings, kCardSettings);
    if (!text) return;
    auto settings = settings::parse(*text);
    if (!settings) return refuse(kCardSettings, settings.error());
    found_.brought.settings = std::move(*settings);
  }

  const Settings& counting() const { return found_.brought.settings ? *found_.brought.settings : now_; }

  void read_network() {
    const auto text = text_of(card_, kCardNetwork, kCardNetwork);
    if (!text) return;
    const auto value = codec::parse_json(*text);
    if (!value) return refuse(kCardNetwork, value.error());
    const auto numbers = numbers_of(*value, *text);
    if (!numbers) return refuse(kCardNetwork, numbers.error());
    const Settings settings = settings::in_use(counting());
    const auto findings = network::check(*numbers, std::nullopt,
                                         {.allow_overlap = settings.network.allow_overlap,
                                          .confirm_within = settings.network.confirm_within,
                                          .command_post = settings.command_post,
                                          .courses = settings.courses,
                                          .listen = settings.team.listen,
                                          .asker = "",
                                          .name = ""});
    if (!findings.errors.empty()) return refuse(kCardNetwork, findings.errors);
    found_.brought.numbers = *numbers;
  }

  /// Reads bare numbers, or numbers with a format as in the files of the image and of adit-network.
  static std::expected<network::Numbers, std::vector<settings::Error>> numbers_of(const codec::Value& value,
                                                                                  const std::string& text) {
    const auto* object = std::get_if<codec::Value::Object>(&value.is);
    const bool has_format =
        object != nullptr &&
        std::ranges::find(*object, "format", &codec::Value::Member::first) != object->end();
    if (!has_format) return network::read_numbers(value);
    auto numbers = network::read_kept(text);
    if (!numbers) return std::unexpected(std::vector<settings::Error>{{"", std::move(numbers.error())}});
    return *numbers;
  }

  void read_secrets() {
    const auto folder = card_.folder(kCardSecrets);
    if (!folder) return refuse(kCardSecrets, "expected a directory");
    if (!*folder) return;
    const auto names = (*folder)->names();
    if (!names) return refuse(kCardSecrets, names.error());
    for (const std::string& name : *names) {
      if (!is_spent(name)) read_token(**folder, name);
    }
  }

  void read_token(const UntrustedFolder& folder, const std::string& file) {
    const std::string name = icd::sentence(kCardSecrets, "/", file);
    if (file == kCardCode) return read_code(folder, name);
    auto known = settings::token_names(counting());
    for (std::string& each : known) each += settings::kTokenEnding;
    if (std::ranges::find(known, file) == known.end())
      return refuse(name,
                    icd::sentence("unknown name; expected one of ", icd::listed(known), ", ", kCardCode));
    const auto text = text_of(folder, file, name);
    if (!text) return;
    auto token = icd::BearerToken::parse(icd::trimmed(*text));
    if (!token) return refuse(name, "expected one token of 1 to 256 visible ASCII characters");
    found_.brought.tokens.emplace(file, std::move(*token));
  }

  void read_code(const UntrustedFolder& folder, const std::string& name) {
    const auto text = text_of(folder, kCardCode, name);
    if (!text) return;
    auto code = icd::BearerToken::parse(icd::trimmed(*text));
    if (!code || !access::is_code(code->reveal())) return refuse(name, "expected 8 digits");
    found_.brought.tokens.emplace(kCardCode, std::move(*code));
  }

  const UntrustedFolder& card_;
  const Settings& now_;
  Found found_;
};

}  // namespace

Found read_card(const UntrustedFolder& card, const Settings& now) {
  return Reader(card, now).read();
}

}  // namespace adit::applier
