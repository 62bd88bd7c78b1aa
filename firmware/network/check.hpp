#pragma once

#include <optional>
#include <string>
#include <vector>

#include "network/numbers.hpp"

namespace adit::network {

/// One number that is to be another: "team.address", "192.168.7.11", "192.168.8.11"; of the Command Post's
/// addresses, all of them.
struct Difference {
  std::string path, from, to;
};

/// Where the numbers are to be used.
struct Circumstances {
  bool allow_overlap = false;  // network.allow_overlap
  std::chrono::milliseconds confirm_within{90000};
  settings::CommandPost command_post;
  std::vector<settings::Course> courses;  // any of which may be used next
  std::vector<settings::Address> listen;  // team.listen
  std::string asker;                      // the address of the one who asks
  std::string name;                       // the box's own, for mDNS: "adit.local"
};

struct Findings {
  std::vector<settings::Error> errors;  // the change is refused
  std::vector<Difference> changes;
  std::vector<std::string> warnings;  // what it would do that may not be meant
};

/// What of the Command Post's side the team's subnet overlaps: the first that there is, for one is enough to
/// choose another; "" if nothing does. What DHCP will give is not known.
std::string overlap_of(const Numbers& wanted, const Circumstances& circumstances);

/// `present`: what the interfaces have now, as far as it is known.
Findings check(const Numbers& wanted, const std::optional<Numbers>& present,
               const Circumstances& circumstances);

/// "http://192.168.8.11:8000", where the page is to be found with these numbers; "http://adit.local:8000".
/// `name`: "adit.local", what the box is called where its address is not known beforehand (mDNS, RFC 6762).
std::string page_at(const Numbers& numbers, const std::vector<settings::Address>& listen,
                    const std::string& name);

}  // namespace adit::network
