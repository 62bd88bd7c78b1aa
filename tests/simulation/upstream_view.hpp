#pragma once

#include <string>
#include <string_view>

#include "simulation/http.hpp"

namespace adit::simulation {

/// What Adit gives a connection to the Command Post, and takes from it, as events of the history.
class UpstreamView {
 public:
  void left(std::string_view bytes);
  void came(std::string_view bytes);

 private:
  HttpStream requests_, answers_;
  std::string path_;
};

}  // namespace adit::simulation
