#include "spare/content.hpp"

#include "codec/row.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::spare {
namespace {

constexpr std::string_view kAbout = "about", kSettings = "settings", kLedger = "ledger",
                           kCertificate = "certificate", kToken = "token:";
constexpr std::size_t kMostTokens = 256, kLongestHead = 128;

constexpr codec::Member kAboutMembers[] = {
    codec::member<&ExportInfo::box>("box"),
    codec::member<&ExportInfo::name>("name"),
    codec::member<&ExportInfo::version>("version"),
    codec::member<&ExportInfo::at>("at"),
    codec::member<&ExportInfo::stamp>("stamp"),
    codec::member<&ExportInfo::rest_count>("rest_count"),
    codec::member<&ExportInfo::told_at>("told_at"),
    codec::member<&ExportInfo::stamps>("stamps"),
    codec::member<&ExportInfo::reports>("reports").from(0),
    codec::member<&ExportInfo::open>("open").from(0),
    codec::member<&ExportInfo::post>("post"),
    codec::member<&ExportInfo::run>("run"),
    codec::member<&ExportInfo::expected>("expected"),
};

void add(std::string& text, std::string_view name, std::string_view bytes) {
  text += icd::sentence(name, " ", bytes.size(), "\n");
  text += bytes;
}

struct Part {
  std::string_view name, bytes;
};

std::optional<Part> take_part(std::string_view& rest) {
  const std::size_t end = rest.substr(0, kLongestHead).find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  const std::string_view head = rest.substr(0, end);
  const std::size_t blank = head.rfind(' ');
  if (blank == std::string_view::npos) return std::nullopt;
  const auto size = icd::number_in<std::size_t>(head.substr(blank + 1));
  rest.remove_prefix(end + 1);
  if (!size || *size > rest.size()) return std::nullopt;
  const Part part{head.substr(0, blank), rest.substr(0, *size)};
  rest.remove_prefix(*size);
  return part;
}

std::unexpected<std::string> damage_error(const std::string& why) {
  return std::unexpected("cannot read the export: " + why);
}

/// Reads each part once.
class ContentReader {
 public:
  std::optional<std::string> read_part(const Part& part) {
    if (!seen_.emplace(std::string(part.name), true).second) return sentence(part, "is given twice");
    if (part.name == kAbout) return read_about(part);
    if (part.name == kSettings) return keep(content_.settings, part);
    if (part.name == kLedger) return keep(content_.ledger, part);
    if (part.name == kCertificate) return keep(content_.certificate, part);
    return read_token(part);
  }
  std::expected<Content, std::string> finish() {
    for (const std::string_view name : {kAbout, kSettings, kLedger}) {
      if (!seen_.contains(std::string(name))) return damage_error(icd::sentence(name, " is missing"));
    }
    return std::move(content_);
  }

 private:
  static std::string sentence(const Part& part, std::string_view why) {
    return icd::sentence(part.name, " ", why);
  }
  static std::optional<std::string> keep(std::string& into, const Part& part) {
    into = part.bytes;
    return std::nullopt;
  }
  std::optional<std::string> read_about(const Part& part) {
    auto about = codec::read_file<ExportInfo>(part.bytes);
    if (!about) return sentence(part, about.error());
    content_.about = *std::move(about);
    return std::nullopt;
  }
  std::optional<std::string> read_token(const Part& part) {
    auto token = icd::BearerToken::parse(part.bytes);
    if (!part.name.starts_with(kToken) || content_.tokens.size() == kMostTokens)
      return std::string("it has a part that this version of Adit does not know");
    if (!token) return sentence(part, "is not a token");
    content_.tokens.emplace(part.name.substr(kToken.size()), *std::move(token));
    return std::nullopt;
  }

  Content content_;
  std::map<std::string, bool> seen_;
};

}  // namespace

constexpr codec::Row ExportInfo::kRow = codec::complete<ExportInfo>({"", kAboutMembers});

std::string write(const Content& content) {
  std::string text;
  add(text, kAbout, codec::write_file(content.about));
  add(text, kSettings, content.settings);
  for (const auto& [name, token] : content.tokens) add(text, icd::sentence(kToken, name), token.reveal());
  if (!content.certificate.empty()) add(text, kCertificate, content.certificate);
  add(text, kLedger, content.ledger);
  return text;
}

std::expected<Content, std::string> read(std::string_view text) {
  ContentReader reading;
  while (!text.empty()) {
    const auto part = take_part(text);
    if (!part) return damage_error("the end of a part is missing");
    if (auto why = reading.read_part(*part)) return damage_error(*why);
  }
  return reading.finish();
}

}  // namespace adit::spare
