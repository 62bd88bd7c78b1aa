// What the records of a journal say, whatever that is.
#include "journal/journal.hpp"

#include "target.hpp"

namespace adit::fuzz {
namespace {

using journal::HandoverState;
using journal::RecordKind;

using Records = std::vector<std::pair<RecordKind, std::string>>;

Records snapshot_of(const HandoverState& carried) {
  Records records;
  carried.write([&records](RecordKind kind, std::string_view said) { records.emplace_back(kind, said); });
  return records;
}

HandoverState replayed(const Records& records) {
  HandoverState carried;
  for (const auto& [kind, said] : records) carried.apply(kind, said);
  return carried;
}

/// Of each a byte that is its kind, two that are its length, and what it says.
Records records_of(Input input) {
  Records records;
  while (input.size() >= 3) {
    const auto bytes = bytes_of(input.substr(0, 3));
    const std::size_t size = bytes[1] | bytes[2] << 8U;
    records.emplace_back(static_cast<RecordKind>(bytes[0]), input.substr(3, size));
    input.remove_prefix(std::min(input.size(), 3 + size));
  }
  return records;
}

}  // namespace

void try_journal(Input input) {
  // A snapshot says what the records before it came to.
  const Records once = snapshot_of(replayed(records_of(input)));
  require(snapshot_of(replayed(once)) == once);
}

}  // namespace adit::fuzz
