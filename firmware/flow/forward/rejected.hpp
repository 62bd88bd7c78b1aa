#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"
#include "queues/rejected_messages.hpp"

namespace adit::forward {

/// Rejected maps, states and markers, and maps that were put aside (queues::RejectedMessages), in a directory
/// that survives the process: `N.cbor`, the message, and `N.json`, the reason. The writer writes in order.
///
/// A message always has a file: its origin's until on_stored(), and this store's until it is queued again.
class RejectedStore {
 public:
  /// The keeper of a message before its rejection. Both are called on the loop, not inside their own add().
  struct Origin {
    /// Called once: whether the message has a file here. If not, it is in memory alone.
    std::function<void(bool kept)> on_stored = [](bool) {};
    /// Called once: the origin may delete its file.
    std::function<void()> release = [] {};
  };

  /// `writer` outlives this.
  RejectedStore(const loop::Loop& loop, loop::Writer& writer, std::string folder);

  /// Restores the messages of the previous process.
  void restore();
  /// Why restore() could not read a file, or "".
  const std::string& unread() const { return unread_; }
  /// Which messages of the previous process are missing in rows(), and why; or "".
  const std::string& missing() const { return missing_; }
  /// A sentence for each map that was put aside, or "".
  std::string put_aside() const;

  /// `bounds`: of a grid that replaced others (queues::QueuedMap). `faults`: of a map that is put aside.
  void add(queues::Message message, int status, const std::string& why, std::size_t bytes, Origin origin,
           const std::optional<icd::GridBounds>& bounds = {}, int faults = 0);
  /// The Command Post accepted `message`: marks older rejected messages that it contains, which are never
  /// sent. Forget `message` only after `written`, called on the loop. False: no mark to write, and no call.
  bool mark_contained(const queues::Message& message, std::function<void()> written = [] {});
  bool empty() const { return items_.items().empty(); }
  /// Messages that were removed for newer ones.
  std::uint64_t dropped_count() const { return dropped_; }
  /// True if the writer has finished.
  bool has_stored_all() const { return being_written_ == 0; }

  /// Takes a message for sending. Call finish_resend() next. An error: why it cannot be sent.
  std::expected<queues::RejectedMessage, std::string> begin_resend(std::uint64_t number);
  /// `kept`: the message is queued and stored elsewhere; otherwise it stays rejected. False: a newer message
  /// that contains it was accepted.
  bool finish_resend(std::uint64_t number, bool kept);
  std::expected<void, std::string> discard(std::uint64_t number);

  std::vector<facts::RejectedRow> rows() const;

 private:
  std::string path(std::uint64_t number, const char* ending) const;
  void keep(const queues::RejectedMessage& item, Origin origin);
  void on_stored(std::uint64_t number, bool well, const Origin& origin);
  void forget(std::uint64_t number);
  void release_origin(std::uint64_t number);
  icd::Checked<void> restore_one(std::uint64_t number);

  const loop::Loop& loop_;
  loop::Writer& writer_;
  const std::string folder_;
  std::string unread_;  // why restore() failed; file numbers may be reused then
  std::string missing_;
  queues::RejectedMessages items_;
  int being_written_ = 0;
  std::set<std::uint64_t> leaving_;                           // between begin_resend() and finish_resend()
  std::map<std::uint64_t, std::function<void()>> in_memory_;  // messages without a file, and their origins
  std::uint64_t dropped_ = 0;
};

}  // namespace adit::forward
