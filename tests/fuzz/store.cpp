// A log's files: damaged, and with any frames whose checksums are right.
#include <map>

#include "folder.hpp"
#include "store/log.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

using namespace store;

constexpr std::uint64_t kSalt = 7;
constexpr LogOptions kKeeping{{8, 1}, 0, false};

FileName name_of(unsigned byte) {
  if (byte % 4 == 3) return {FileName::Kind::Snapshot, 2, kSalt};
  return {FileName::Kind::Log, 1 + byte % 4, kSalt};
}

/// The files begin with headers whose bases are the first bytes. Then of each six bytes a frame: its file,
/// kind, sequence number, process, durable, and length; its body follows. One of kind 255 is these bytes as
/// they are.
std::map<std::string, std::string> files_of(Input input) {
  std::map<std::string, std::string> files;
  std::uint64_t base = 0;
  for (unsigned file = 0; file < 4 && !input.empty(); ++file, input.remove_prefix(1)) {
    const FileName name = name_of(file);
    base += bytes_of(input)[0] % 8;
    const std::string header = FileHeader{.number = name.number, .salt = kSalt, .base = base}.to_bytes();
    files[name.text()] = to_bytes({.kind = kFileBegins, .process = 1, .durable = base, .body = header},
                                  kKeeping.layout, kSalt, 0);
  }
  while (input.size() >= 6) {
    const auto bytes = bytes_of(input.substr(0, 6));
    std::string& file = files[name_of(bytes[0]).text()];
    const std::string body(input.substr(6, bytes[5]));
    file.resize((file.size() + 7) / 8 * 8);
    file += bytes[1] == 255 ? body
                            : to_bytes({bytes[1], bytes[2], bytes[3], bytes[4], body}, kKeeping.layout, kSalt,
                                       file.size());
    input.remove_prefix(std::min<std::size_t>(input.size(), 6U + bytes[5]));
  }
  return files;
}

/// Each record has a place behind the one before, and each number that is left out is in a gap.
std::vector<std::string> bodies_of(const Contents& contents) {
  std::vector<std::string> bodies;
  std::uint64_t last = 0;
  bool gap = true;  // a snapshot says where the numbers begin
  for (const Item& item : contents.items) {
    const auto* record = std::get_if<Record>(&item);
    if (record != nullptr && record->sequence != 0) {
      require(record->sequence > last && (gap || record->sequence == last + 1));
      last = record->sequence;
    }
    if (record != nullptr) bodies.emplace_back(record->body);
    gap = record == nullptr || record->sequence == 0;
  }
  return bodies;
}

}  // namespace

void try_store(Input input) {
  static const Folder folder;
  folder.clear();
  for (const auto& [name, bytes] : files_of(input)) folder.put(name, bytes);
  std::vector<std::string> bodies;
  {
    const auto directory = Directory::lock(folder.path());
    const auto contents = Contents::read(*directory, kKeeping);
    if (!contents) return require(contents.error().cause == Error::Cause::Newer);
    bodies = bodies_of(*contents);
    Log log(*directory, kKeeping);
    require(log.start(*contents).has_value());
    require(log.append(1, "one more", Durability::Now).has_value());
  }
  bodies.emplace_back("one more");
  const auto again = Contents::read(*Directory::open(folder.path()), kKeeping);
  require(again.has_value() && bodies_of(*again) == bodies);
}

}  // namespace adit::fuzz
