#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "icd/map_update.hpp"
#include "spool/map_file.hpp"

namespace adit::spool {

/// Keeps what waits across an end of the service, also a sudden one (not across an end of the box: the folder
/// is in memory), each message in the form that goes upstream, a map with its data first. A message is there
/// whole or not at all. What cannot be written is logged, and waits in memory alone.
class Spool {
 public:
  using Kept = std::vector<std::pair<std::uint64_t, icd::MapUpdate>>;  // by number

  /// Makes the folder, for this user alone. Of the room that its file system has, so much is left to others,
  /// but no more than a quarter of all: what is to be written there beside maps must not be refused for them.
  explicit Spool(std::string folder, std::uint64_t left_to_others = 0);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// So much from now on, whoever asks.
  void leave_to_others(std::uint64_t bytes) { left_to_others_ = bytes; }

  /// For a map whose data is put into its file as it arrives. For the writer, which is to have the last of
  /// it, too.
  std::shared_ptr<MapFile> begin();
  /// Whether there is room for so much.
  bool has_room(std::uint64_t bytes) const;
  /// Keeps a map until forget(), and gives it back with its data in the file, each chunk freed as it is
  /// written; in `begun`, where its data begins with what was stored there. Refused with 503, and no file
  /// left, where there is no room for it and `spare` bytes more, or the folder cannot be written, or read()
  /// could not read it: the number may be that of a map which a life before kept. Once it
  /// returns, the map outlives any death of the process. For the writer.
  icd::Checked<icd::MapUpdate> keep(std::uint64_t number, icd::MapUpdate map, std::uint64_t spare,
                                    std::shared_ptr<MapFile> begun = nullptr);
  /// For the writer. The data lives on for as long as somebody has it.
  void forget(std::uint64_t number);
  /// Why no map could be kept, or "".
  std::string trouble() const;

  /// Work on these maps begins, and ends. If two processes in a row have ended in it, the next read() sets
  /// the maps aside.
  void work_begins(const std::vector<std::uint64_t>& numbers);
  void work_ends() const;
  /// Which maps read() has set aside for that: a sentence, or "".
  const std::string& ended_processes() const { return ended_processes_; }

  /// All maps that are kept. A damaged file is logged and set aside. If a file cannot be read, all stay, none
  /// is given, because a newer map must not go before an older one, and keep() refuses every map until the
  /// next start.
  Kept read();
  /// Why read() could not read a file, or "".
  const std::string& unread() const { return unread_; }
  /// It is damaged: it is forgotten, and its file is there for whoever looks for it. For the writer.
  void set_aside(std::uint64_t number, const std::string& why);

 private:
  std::string file_of(std::uint64_t number) const;
  std::string work_file() const { return folder_ + "/at-work"; }
  void count_ends();

  std::string folder_, unread_;         // why read() could not
  std::set<std::uint64_t> ended_once_;  // maps that the process before was working on when it ended
  std::string ended_processes_;
  std::atomic<std::uint64_t> left_to_others_;  // the writer asks, too
};

}  // namespace adit::spool
