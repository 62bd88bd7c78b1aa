#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace adit::simulation {

/// Actions that are left out of a run. An action has its actor's name and a number, from 1. All other draws
/// of the seed stay the same.
class Omissions {
 public:
  Omissions() = default;
  /// Parses "ends/2,client 10.0.0.21/3-9,Silence": one action, a range, all actions of an actor. Ignores
  /// other words.
  explicit Omissions(std::string_view words);

  /// Whether that action of that actor is left out.
  bool has(const std::string& actor, std::uint64_t number) const;
  void add(const std::string& actor, std::uint64_t first, std::uint64_t last);
  void add_all(const std::string& actor) { whole_.insert(actor); }
  bool empty() const { return whole_.empty() && numbers_.empty(); }
  /// In the format of the constructor.
  std::string words() const;

 private:
  void read(std::string_view word);

  std::set<std::string> whole_;
  std::map<std::string, std::set<std::uint64_t>> numbers_;
};

/// The number of actions of each actor of a run, including those left out.
using Actions = std::map<std::string, std::uint64_t>;

}  // namespace adit::simulation
