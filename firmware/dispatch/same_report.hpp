#pragma once

#include "icd/artifact_report.hpp"

namespace adit::dispatch {

/// Metres, on each axis: less than any robot knows, and more than a float32 rounds off.
inline constexpr double kSamePlace = 1e-3;

/// The same report again: the same type, whatever its letter case (ICD 5.2), at the same place.
bool is_same(const icd::ArtifactReport& one, const icd::ArtifactReport& other);

/// Both of one type and at most `metres` apart.
bool is_near(const icd::ArtifactReport& one, const icd::ArtifactReport& other, double metres);

/// In metres.
double distance(const icd::ArtifactReport& one, const icd::ArtifactReport& other);

}  // namespace adit::dispatch
