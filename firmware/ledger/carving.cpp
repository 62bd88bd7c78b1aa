#include "ledger/carving.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <utility>

#include "ledger/big_endian.hpp"
#include "ledger/log_file.hpp"
#include "ledger/proof.hpp"
#include "ledger/rows.hpp"

namespace adit::ledger {
namespace {

/// https://www.sqlite.org/fileformat2.html#b_tree_pages: how much of a row lies in its leaf page.
constexpr std::size_t kMostLocal = kPage - 35;
constexpr std::size_t kLeastLocal = (kPage - 12) * 32 / 255 - 23;
constexpr std::size_t kLongestRow = 1 << 20;
constexpr std::size_t kOverflow =
    kPage - 4;                   // bytes of a row in a page of its own, after the next one's number
constexpr int kMostTries = 256;  // combinations of such pages, for one row

/// Reads on from `text`, which it shortens.
std::optional<std::uint64_t> take_varint(std::string_view& text) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 9 && i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    value = i == 8 ? value << 8 | byte : value << 7 | (byte & 0x7f);
    if (i < 8 && (byte & 0x80) != 0) continue;
    text.remove_prefix(i + 1);
    return value;
  }
  return std::nullopt;
}

std::size_t size_of(std::uint64_t serial_type) {
  constexpr std::size_t kSizes[] = {0, 1, 2, 3, 4, 6, 8, 8, 0, 0, 0, 0};
  return serial_type < 12 ? kSizes[serial_type] : static_cast<std::size_t>((serial_type - 12) / 2);
}

/// A value that may stand in a column of `kind`; nothing: it may not.
std::optional<Value> value_of(std::uint64_t type, std::string_view bytes, char kind) {
  const auto kind_now = static_cast<char>(std::tolower(static_cast<unsigned char>(kind)));
  if (type == 0) return kind != kind_now ? std::optional<Value>(Value()) : std::nullopt;
  if (type == 10 || type == 11) return std::nullopt;
  if (type >= 12) {
    if (kind_now == (type % 2 == 0 ? 'b' : 't')) {
      return type % 2 == 0 ? Value(Blob{std::string(bytes)}) : Value(std::string(bytes));
    }
    return std::nullopt;
  }
  if (kind_now != 'i' && kind_now != 'r') return std::nullopt;
  if (type == 7) {
    return kind_now == 'r' ? std::optional<Value>(std::bit_cast<double>(big_endian(bytes))) : std::nullopt;
  }
  std::int64_t number = type == 9 ? 1 : 0;
  if (type < 7) {
    const auto unused = static_cast<int>(64 - 8 * bytes.size());
    number = static_cast<std::int64_t>(big_endian(bytes) << unused) >> unused;
  }
  return kind_now == 'r' ? Value(static_cast<double>(number)) : Value(number);
}

std::int64_t proof_of(const Row& row) {
  Proof proof;
  for (const Value& value : row) {
    if (const auto* const number = std::get_if<std::int64_t>(&value)) proof.add(*number);
    if (const auto* const real = std::get_if<double>(&value)) proof.add(*real);
    if (const auto* const text = std::get_if<std::string>(&value)) proof.add_text(*text);
    if (const auto* const blob = std::get_if<Blob>(&value)) proof.add_blob(blob->bytes);
    if (std::holds_alternative<std::monostate>(value)) proof.null();
  }
  return proof.value();
}

struct Head {
  std::int64_t number = 0;
  std::size_t size = 0;              // of the row's record, with its header
  std::vector<std::uint64_t> types;  // of its columns
  std::size_t header = 0;            // of the record
};

/// Of a row that may begin at the start of `page`, which is shortened to its record; nothing: none does.
std::optional<Head> take_head(std::string_view& page) {
  constexpr std::uint64_t kMostColumns = 64;
  Head head;
  const auto size = take_varint(page);
  if (!size || *size < kMarkKinds.size() || *size > kLongestRow) return std::nullopt;
  const auto number = take_varint(page);
  if (!number || *number == 0 || *number > 1'000'000'000'000) return std::nullopt;
  std::string_view rest = page;
  const auto header = take_varint(rest);
  if (!header || *header > 4 * kMostColumns || *header > *size || *header > page.size()) return std::nullopt;
  const std::size_t taken = page.size() - rest.size();
  // The number is not in the record again: its first column is NULL.
  if (*header <= taken || rest.front() != 0) return std::nullopt;
  std::string_view types = page.substr(taken, *header - taken);
  std::size_t whole = *header;
  while (!types.empty()) {
    const auto type = take_varint(types);
    if (!type || *type > 2 * kLongestRow) return std::nullopt;
    head.types.push_back(*type);
    whole += size_of(*type);
  }
  if (whole != *size) return std::nullopt;
  head.number = static_cast<std::int64_t>(*number);
  head.size = *size;
  head.header = *header;
  return head;
}

std::size_t local_size(std::size_t size) {
  if (size <= kMostLocal) return size;
  const std::size_t some = kLeastLocal + (size - kLeastLocal) % kOverflow;
  return some <= kMostLocal ? some : kLeastLocal;
}

/// A row in one of its forms.
struct Form {
  Row row;
  bool proven = false;
};
using Forms = std::map<std::int64_t, Form>;

struct Table {
  std::string_view kinds;
  Forms* forms;
  std::size_t latest;  // the column that tells of two forms of a row which is the later one
};

/// How late a form of a row is, by that column: a text that grows, or a time; then, whether it is proven.
std::pair<double, bool> lateness(const Form& form, std::size_t column) {
  if (const auto* const text = std::get_if<std::string>(&form.row[column]))
    return {static_cast<double>(text->size()), form.proven};
  if (const auto* const time = std::get_if<double>(&form.row[column])) return {*time, form.proven};
  return {0, form.proven};
}

/// The rows of `forms`; `unproven`: whether one of them is not.
std::map<std::int64_t, Row> rows_of(Forms forms, bool& unproven) {
  std::map<std::int64_t, Row> rows;
  for (auto& [number, form] : forms) {
    unproven = unproven || !form.proven;
    rows.emplace(number, std::move(form.row));
  }
  return rows;
}

class Carver {
 public:
  Carver(std::string_view file, std::string_view log) {
    for (std::size_t at = 0; at + kPage <= file.size() + kPage - 1; at += kPage) {
      add(at / kPage + 1, file.substr(at, kPage));
    }
    for (std::size_t at = kLogHeader; at + kFrameHeader < log.size(); at += kFrame) {
      add(big_endian(log.substr(at, 4)), log.substr(at + kFrameHeader, kPage));
    }
  }

  Carved carve() {
    look_everywhere(true);
    if (reports_.empty() && runs_.empty()) look_everywhere(false);
    carved_.reports = rows_of(std::move(reports_), carved_.unproven);
    carved_.runs = rows_of(std::move(runs_), carved_.unproven);
    carved_.sightings = rows_of(std::move(sightings_), carved_.unproven);
    carved_.robots = rows_of(std::move(robots_), carved_.unproven);
    std::erase_if(carved_.robots, [this](const auto& row) { return !carved_.reports.contains(row.first); });
    return std::move(carved_);
  }

 private:
  void add(std::uint64_t number, std::string_view page) {
    if (std::ranges::all_of(page, [](char byte) { return byte == 0; })) return;
    pages_.push_back(page);
    by_number_[number].push_back(page);
  }

  void look_everywhere(bool proven) {
    proven_ = proven;
    for (const std::string_view page : pages_) {
      for (std::size_t at = 0; at < page.size(); ++at) look_at(page.substr(at));
    }
  }

  void look_at(std::string_view text) {
    const auto head = take_head(text);
    if (!head) return;
    const std::size_t columns = head->types.size() - (proven_ ? 1 : 0);
    if (columns == kMarkKinds.size() && proven_) return look_for_mark(*head, text);
    for (const Table& table :
         {Table{kReportKinds, &reports_, kReportKinds.size() - 1}, Table{kRunKinds, &runs_, kRunHeard},
          Table{kSightingKinds, &sightings_, kSightingKinds.size() - 1},
          Table{kRobotKinds, &robots_, kRobotKinds.size() - 1}}) {
      if (columns == table.kinds.size()) take(*head, text, table);
    }
  }

  void look_for_mark(const Head& head, std::string_view text) {
    if (head.size > text.size()) return;
    const auto mark = form_of(head, text.substr(0, head.size), kMarkKinds);
    if (!mark || !mark->proven) return;
    carved_.highest = std::max(carved_.highest.value_or(0), std::get<std::int64_t>(mark->row.back()));
  }

  void take(const Head& head, std::string_view text, const Table& table) {
    auto form = whole_row(head, text, table.kinds);
    if (!form) return;
    const auto [had, is_new] = table.forms->try_emplace(head.number, *form);
    if (!is_new && lateness(*form, table.latest) >= lateness(had->second, table.latest)) {
      had->second = std::move(*form);
    }
  }

  /// With what of it lies in pages of its own. Each of those may be there in several forms; the proof tells.
  std::optional<Form> whole_row(const Head& head, std::string_view text, std::string_view kinds) {
    const std::size_t local = local_size(head.size);
    if (local == head.size) {
      return head.size > text.size() ? std::nullopt : form_of(head, text.substr(0, head.size), kinds);
    }
    if (local + 4 > text.size()) return std::nullopt;
    int tries = kMostTries;
    return joined_row(head, std::string(text.substr(0, local)), big_endian(text.substr(local, 4)), kinds,
                      tries);
  }

  std::optional<Form> joined_row(const Head& head, const std::string& so_far, std::uint64_t next,
                                 std::string_view kinds, int& tries) {
    if (so_far.size() == head.size) return form_of(head, so_far, kinds);
    const auto found = by_number_.find(next);
    if (found == by_number_.end()) return std::nullopt;
    for (auto page = found->second.rbegin(); page != found->second.rend() && tries-- > 0; ++page) {
      if (page->size() < kPage) continue;
      const std::size_t length = std::min(kOverflow, head.size - so_far.size());
      const std::string longer = so_far + std::string(page->substr(4, length));
      if (auto form = joined_row(head, longer, big_endian(page->substr(0, 4)), kinds, tries)) return form;
    }
    return std::nullopt;
  }

  std::optional<Form> form_of(const Head& head, std::string_view record, std::string_view kinds) const {
    Row row{Value(head.number)};
    std::string_view body = record.substr(head.header);
    std::size_t column = 0;
    for (const std::uint64_t type : head.types) {
      const std::string_view bytes = body.substr(0, size_of(type));
      body.remove_prefix(bytes.size());
      if (column == 0) {  // the number is not in the record
        if (type != 0) return std::nullopt;
      } else {
        auto value = value_of(type, bytes, column < kinds.size() ? kinds[column] : 'i');
        if (!value) return std::nullopt;
        row.push_back(*std::move(value));
      }
      ++column;
    }
    return judged(std::move(row), kinds);
  }

  /// Takes the proof out of it. A row that has none is right if it has the form of one.
  std::optional<Form> judged(Row row, std::string_view kinds) const {
    if (proven_) {
      const std::int64_t proof = std::get<std::int64_t>(row.back());
      row.pop_back();
      const bool proven = proof == proof_of(row);
      if (proven || proof != kNoProof)
        return proven ? std::optional(Form{std::move(row), true}) : std::nullopt;
    }
    if (kinds == kSightingKinds || kinds == kRobotKinds) return std::nullopt;  // version 3 writes none
    const auto* const history = std::get_if<std::string>(&row.back());
    if (kinds == kReportKinds && (history == nullptr || !steps_of(0, *history))) return std::nullopt;
    return Form{std::move(row), false};
  }

  static constexpr std::size_t kRunHeard = 8;

  std::vector<std::string_view> pages_;
  std::map<std::uint64_t, std::vector<std::string_view>> by_number_;
  Forms reports_, runs_, sightings_, robots_;
  Carved carved_;
  bool proven_ = true;
};

}  // namespace

Carved carve(std::string_view file, std::string_view log) {
  return Carver(file, log).carve();
}

}  // namespace adit::ledger
