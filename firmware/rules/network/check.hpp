#pragma once

#include <optional>
#include <string>
#include <vector>

#include "network/numbers.hpp"

namespace adit::network {

/// One changed value: "team.address", "192.168.7.11", "192.168.8.11". The Command Post's addresses are one.
struct Difference {
  std::string path, from, to;
};

/// The settings and the client that a change is checked against.
struct Circumstances {
  bool allow_overlap = false;  // network.allow_overlap
  std::chrono::milliseconds confirm_within{90000};
  settings::CommandPost command_post;
  std::vector<settings::Course> courses;  // the box may switch to any of them
  std::vector<settings::Address> listen;  // team.listen
  std::string asker;                      // the client's address
  std::string name;                       // the box's mDNS name: "adit.local"
};

struct Findings {
  std::vector<settings::Error> errors;  // if any, the change is rejected
  std::vector<Difference> changes;
  std::vector<std::string> warnings;  // effects that the user may not intend
};

/// The Command Post's first network that overlaps the team's subnet, or "". DHCP addresses are not checked.
std::string overlap_of(const Numbers& wanted, const Circumstances& circumstances);

/// `present`: the interfaces' numbers now, if known.
Findings check(const Numbers& wanted, const std::optional<Numbers>& present,
               const Circumstances& circumstances);

/// The page's address with these numbers: "http://192.168.8.11:8000". If the address is not known in advance,
/// uses `name`, the box's mDNS name (RFC 6762): "http://adit.local:8000".
std::string page_at(const Numbers& numbers, const std::vector<settings::Address>& listen,
                    const std::string& name);

}  // namespace adit::network
