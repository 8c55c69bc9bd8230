#pragma once

#include <functional>

namespace evit {

/// Calls work(i) for i in 0..n-1 on `threads` threads (1: on the caller's), in any order. An exception of
/// `work` is thrown again here, after all threads have ended.
void ParallelFor(int n, int threads, const std::function<void(int)>& work);

}  // namespace evit
