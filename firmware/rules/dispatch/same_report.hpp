#pragma once

#include "icd/artifact_report.hpp"

namespace adit::dispatch {

/// Metres per axis: below a robot's accuracy, above the rounding of float32.
inline constexpr double kSamePlace = 1e-3;

/// Same type in any letter case (ICD 5.2) and same place.
bool is_same(const icd::ArtifactReport& one, const icd::ArtifactReport& other);

/// Same type, at most `metres` apart.
bool is_near(const icd::ArtifactReport& one, const icd::ArtifactReport& other, double metres);

/// In metres.
double distance(const icd::ArtifactReport& one, const icd::ArtifactReport& other);

/// A quoted type and a place: "Drill" at 1, 2.5, 3
std::string described(const icd::ArtifactReport& report);

}  // namespace adit::dispatch
