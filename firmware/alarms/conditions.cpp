#include "alarms/conditions.hpp"

#include "alarms/causes.hpp"
#include "alarms/found.hpp"

namespace adit::alarms {

std::vector<Condition> conditions_of(const Facts& facts) {
  Found found;
  find_network_troubles(facts, found);
  find_post_troubles(facts, found);
  find_report_troubles(facts, found);
  find_robot_troubles(facts, found);
  find_box_troubles(facts, found);
  hide_consequences(found);
  return found;
}

}  // namespace adit::alarms
