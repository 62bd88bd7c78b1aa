#include "dispatch/same_report.hpp"

#include <algorithm>
#include <cmath>

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

char lower(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

bool is_one_type(const std::string& one, const std::string& other) {
  return std::ranges::equal(one, other, {}, lower, lower);
}

}  // namespace

bool is_same(const icd::ArtifactReport& one, const icd::ArtifactReport& other) {
  const auto is_near = [](double a, double b) { return std::abs(a - b) <= kSamePlace; };
  return is_near(one.position.x, other.position.x) && is_near(one.position.y, other.position.y) &&
         is_near(one.position.z, other.position.z) && is_one_type(one.type, other.type);
}

double distance(const icd::ArtifactReport& one, const icd::ArtifactReport& other) {
  return std::hypot(one.position.x - other.position.x, one.position.y - other.position.y,
                    one.position.z - other.position.z);
}

bool is_near(const icd::ArtifactReport& one, const icd::ArtifactReport& other, double metres) {
  return is_one_type(one.type, other.type) && distance(one, other) <= metres;
}

std::string described(const icd::ArtifactReport& report) {
  const icd::Point& at = report.position;
  return icd::sentence(icd::in_quotes(report.type), " at ", at.x, ", ", at.y, ", ", at.z);
}

}  // namespace adit::dispatch
