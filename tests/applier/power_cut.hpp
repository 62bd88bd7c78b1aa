#pragma once

#include <functional>

namespace adit::applier {

/// Runs `work` in a child process that ends just before its nth call that changes the disk, counted from 1.
/// Returns false if there were fewer calls.
bool cut_at(int nth, const std::function<void()>& work);

}  // namespace adit::applier
