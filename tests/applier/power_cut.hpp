#pragma once

#include <functional>

namespace adit::applier {

/// Runs `work` in a process of its own that ends just before its nth call that changes the disk, counted from
/// 1. False: it had fewer.
bool cut_at(int nth, const std::function<void()>& work);

}  // namespace adit::applier
