#pragma once

#include <cstddef>
#include <functional>

namespace evit {

/// Calls work(0) .. work(count - 1), each once, in `threads` threads (this one among them), and waits. What
/// is thrown is thrown here, after all threads have stopped.
void InParallel(int threads, std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace evit
