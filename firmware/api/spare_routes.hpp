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

  intake::Answer shown() const;
  intake::Answer stand_by();
  intake::Answer resume();
  void exported(const Call& call);
  void to_stick(const Call& call);
  intake::Answer from_stick(const std::string& body);
  std::unique_ptr<intake::BodySink> take_in(const Call& call);
  void open(const Call& call);
  intake::Answer forget();
  intake::Answer take_over(const std::string& body);

 private:
  /// The present state, or the refusal.
  intake::Answer after(const icd::Checked<void>& done) const;

  Spare& spare_;
};

}  // namespace adit::api
