#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "api/run_view.hpp"
#include "lanes/rejected_messages.hpp"
#include "loop/loop.hpp"
#include "loop/workers.hpp"

namespace adit::forward {

/// Maps, states and markers that the Command Post would not take (lanes::RejectedMessages), on the page and
/// in a folder that outlives the service: `N.cbor`, the message as it goes upstream, and `N.json`, why it is
/// there. Its files are written by the writer, in order.
///
/// A message that comes here or goes from here is never without a file: whoever had it keeps its own until it
/// is told that there is one here, and the one here stays until it has one again.
class RejectedStore {
 public:
  /// Who kept a message before it was rejected. Both are called on the loop, and never from within add().
  struct Origin {
    /// Once: whether it is kept here now. If not, it is rejected in memory alone.
    std::function<void(bool kept)> told = [](bool) {};
    /// Once: it is kept here, or has gone from here, so that the origin's own file can go.
    std::function<void()> let_go = [] {};
  };

  /// `writer` outlives this.
  RejectedStore(const loop::Loop& loop, loop::Writer& writer, std::string folder);

  /// What an earlier service kept.
  void restore();
  /// Why restore() could not read a file, or "".
  const std::string& unread() const { return unread_; }

  void add(lanes::Message message, int status, const std::string& why, std::size_t bytes, Origin origin);
  /// The Command Post took it: what it says all of is not to be sent again, in a life to come neither.
  /// Whoever keeps the message forgets it only once that is written: then `written` is called, on the loop.
  /// False: there is nothing to write, and `written` is not called.
  bool taken(const lanes::Message& message, std::function<void()> written = [] {});
  bool empty() const { return items_.items().empty(); }
  /// What made place for newer ones and was not replaced, ever.
  std::uint64_t dropped() const { return dropped_; }
  /// Whether all that was to be told by the writer has been.
  bool all_kept() const { return being_written_ == 0; }

  /// For whoever sends it again and then says so by sent_again(). An error: a sentence why it is not sent.
  std::expected<lanes::Message, std::string> to_be_sent(std::uint64_t number);
  /// `kept`: it waits, and is kept elsewhere. Otherwise it is rejected as before. False: something newer
  /// that says all of it was taken meanwhile.
  bool sent_again(std::uint64_t number, bool kept);
  std::expected<void, std::string> discard(std::uint64_t number);

  std::vector<api::RejectedRow> rows() const;

 private:
  std::string path(std::uint64_t number, const char* ending) const;
  void keep(const lanes::RejectedMessage& item, Origin origin);
  void kept(std::uint64_t number, bool well, const Origin& origin);
  void forget(std::uint64_t number);
  void let_origin_go(std::uint64_t number);
  icd::Checked<void> restore_one(std::uint64_t number);

  const loop::Loop& loop_;
  loop::Writer& writer_;
  const std::string folder_;
  std::string unread_;  // why restore() could not read it: its files' numbers may be given again
  lanes::RejectedMessages items_;
  int being_written_ = 0;
  std::set<std::uint64_t> leaving_;                           // between to_be_sent() and sent_again()
  std::map<std::uint64_t, std::function<void()>> in_memory_;  // those without a file, and who is let go then
  std::uint64_t dropped_ = 0;
};

}  // namespace adit::forward
