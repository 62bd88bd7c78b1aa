// A journal's file: damaged, and whole with anything said in its records.
#include "journal/carried.hpp"
#include "journal/record.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

using journal::Carried;
using journal::Kind;

std::string snapshot_of(const Carried& carried) {
  std::string records;
  carried.write([&records](Kind kind, std::string_view said) { records += journal::framed(kind, said); });
  return records;
}

Carried replayed(std::string_view records) {
  Carried carried;
  std::size_t told = 0;
  journal::for_each_record(records, [&](Kind kind, std::string_view said) {
    carried.apply(kind, said);
    return ++told <= records.size();
  });
  return carried;
}

/// Records with their checksums right: of each a byte that is its kind, two that are its length, and what it
/// says.
std::string framed_records(Input input) {
  std::string records;
  while (input.size() >= 3) {
    const auto bytes = bytes_of(input.substr(0, 3));
    const std::size_t size = bytes[1] | bytes[2] << 8U;
    records += journal::framed(static_cast<Kind>(bytes[0]), input.substr(3, size));
    input.remove_prefix(std::min(input.size(), 3 + size));
  }
  return records;
}

}  // namespace

void try_journal(Input input) {
  (void)replayed(input);
  // A snapshot says what the records before it came to.
  const std::string once = snapshot_of(replayed(framed_records(input)));
  require(snapshot_of(replayed(once)) == once);
}

}  // namespace adit::fuzz
