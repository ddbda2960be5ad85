// Work in parallel whose result does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>

namespace astroid {

/// The number of threads this process may run at a time (its processor affinity), at least 1.
[[nodiscard]] int available_threads();

/// Calls body(worker, item) once for every item 0 … count-1, on up to `threads` threads, the calling one included.
///
/// Items are begun in rising order. `worker` is 0 … threads-1 and no two calls with the same worker overlap, so it may
/// index buffers that workers own. Returns when all calls have returned, and what they wrote is then visible.
/// After a call throws no further item is begun; the exception of the lowest item that threw is thrown here, the same
/// one for any number of threads.
/// @param threads  < 1: available_threads(). Fewer are used when there are fewer items or the system grants no more.
void parallel_for(int threads, std::size_t count,
                  const std::function<void(std::size_t worker, std::size_t item)>& body);

}  // namespace astroid
