#pragma once

#include <memory>
#include <string>

#include "api/route.hpp"
#include "api/spare.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Spare and standby. Routes: README.md.
class SpareRoutes {
 public:
  /// `spare` must outlive this object.
  explicit SpareRoutes(Spare& spare) : spare_(spare) {}

  void exported(const Call& call);
  void to_stick(const Call& call);
  std::unique_ptr<intake::BodySink> take_in(const Call& call);
  void open(const Call& call);
  intake::Answer take_over(const std::string& body);

 private:
  Spare& spare_;
};

}  // namespace adit::api
