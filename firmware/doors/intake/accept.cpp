#include "intake/accept.hpp"

namespace adit::intake {

std::shared_ptr<void> accept_instead(int, Admit) {
  return nullptr;
}

}  // namespace adit::intake
