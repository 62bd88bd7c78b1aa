#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace adit::simulation {

/// Single things that an actor does in a run, each told apart by the actor's name and a number of its own,
/// from 1 on. Some may be left out: all else that the seed draws stays as it is.
class Omissions {
 public:
  Omissions() = default;
  /// "ends/2,client 10.0.0.21/3-9,Silence": one, a range, all of an actor's. What is no such word leaves out
  /// nothing.
  explicit Omissions(std::string_view words);

  /// Whether that actor's number `number` is left out.
  bool has(const std::string& actor, std::uint64_t number) const;
  void add(const std::string& actor, std::uint64_t first, std::uint64_t last);
  void add_all(const std::string& actor) { whole_.insert(actor); }
  bool empty() const { return whole_.empty() && numbers_.empty(); }
  /// As the constructor reads it.
  std::string words() const;

 private:
  void read(std::string_view word);

  std::set<std::string> whole_;
  std::map<std::string, std::set<std::uint64_t>> numbers_;
};

/// How many things each actor of a run did, or would have done.
using Actions = std::map<std::string, std::uint64_t>;

}  // namespace adit::simulation
