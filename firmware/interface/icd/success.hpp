#pragma once

namespace adit::icd {

/// A 2xx answer (RFC 9110 15.3).
constexpr bool is_success(int status) {
  return status >= 200 && status < 300;
}

}  // namespace adit::icd
