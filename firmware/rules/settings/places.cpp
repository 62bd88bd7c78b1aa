#include <algorithm>

#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "settings/settings.hpp"

namespace adit::settings {
namespace {

/// Finds the member or item at a path in a well-formed document.
class Finder {
 public:
  /// Both must outlive this object.
  Finder(std::string_view json, std::string_view path) : json_(json), path_(path) {}

  /// The byte of its key, or of itself in a list; if it is missing, of what should contain it.
  std::size_t find() {
    skip_space();
    read_value("", at_);
    return found_;
  }

 private:
  char next() const { return at_ < json_.size() ? json_[at_] : '\0'; }
  void skip_space() { at_ = std::min(json_.find_first_not_of(" \t\r\n,:", at_), json_.size()); }

  /// True if `path` is the path or leads to it.
  bool leads_to(std::string_view path) const {
    if (!path_.starts_with(path)) return false;
    return path.empty() || path_.size() == path.size() || std::string_view(".[").contains(path_[path.size()]);
  }

  void read_value(const std::string& path, std::size_t place) {
    if (leads_to(path)) found_ = place;
    if (next() == '{') return read_members(path);
    if (next() == '[') return read_items(path);
    if (next() == '"') return void(read_text());
    at_ = std::min(json_.find_first_of(",]} \t\r\n", at_), json_.size());
  }

  std::string_view read_text() {
    const std::size_t begin = ++at_;
    while (at_ < json_.size() && next() != '"') at_ += next() == '\\' ? 2 : 1;
    at_ = std::min(at_ + 1, json_.size());
    return json_.substr(begin, at_ - begin - 1);
  }

  void read_members(const std::string& path) {
    ++at_;
    for (skip_space(); next() == '"'; skip_space()) {
      const std::size_t place = at_;
      const std::string_view key = read_text();
      skip_space();
      read_value(icd::sentence(path, path.empty() ? "" : ".", key), place);
    }
    ++at_;
  }

  void read_items(const std::string& path) {
    ++at_;
    skip_space();
    for (std::size_t i = 0; at_ < json_.size() && next() != ']'; ++i, skip_space())
      read_value(icd::sentence(path, "[", i, "]"), at_);
    ++at_;
  }

  std::string_view json_, path_;
  std::size_t at_ = 0, found_ = 0;
};

/// Takes the byte that an error of codec::parse_json() names out of its sentence.
std::optional<std::size_t> cut_byte(std::string& what) {
  constexpr std::string_view kBefore = " at byte ";
  const std::size_t begin = what.find(kBefore);
  if (begin == std::string::npos) return std::nullopt;
  const std::size_t digits = begin + kBefore.size(),
                    end = std::min(what.find_first_not_of("0123456789", digits), what.size());
  const auto byte = icd::number_in<std::size_t>(std::string_view(what).substr(digits, end - digits));
  what.erase(begin, end - begin);
  return byte;
}

/// From 1; the column counts characters.
std::string place_of(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte);
  const std::size_t line = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return icd::sentence("line ", std::ranges::count(before, '\n') + 1, ", column ",
                       icd::count_characters(before.substr(line)) + 1);
}

}  // namespace

void find_places(std::string_view json, std::vector<Error>& errors) {
  for (Error& error : errors) {
    const auto byte = error.path.empty() ? cut_byte(error.what) : Finder(json, error.path).find();
    if (byte) error.at = place_of(json, *byte);
  }
}

}  // namespace adit::settings
