#include "icd/members.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace adit::icd {
namespace {

enum class Colour : unsigned char { Red };
struct One {
  int number = 0;
};
struct Many {
  std::string text = {};
  std::optional<std::string> other = {};
  std::vector<One> list = {};
  std::array<double, 3> pairs = {};
  One nested = {};
  Colour colour = Colour::Red;
};
static_assert(count_of_members<One>() == 1);
static_assert(count_of_members<Many>() == 6);

}  // namespace
}  // namespace adit::icd
