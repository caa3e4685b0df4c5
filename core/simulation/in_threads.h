// Independent pieces of work, such as whole runs, on several threads.
//
//     in_threads(scenes.size(), machine_threads(),
//                [&](std::size_t i) { results[i] = run_scene(scenes[i], {}); });
#pragma once

#include <cstddef>
#include <functional>

namespace cloth {

/// Calls work(0), ..., work(count - 1) on up to `threads` threads, the calling one among them, each the next
/// that is left; on fewer where the system gives no more. Returns when all calls have ended. After an
/// exception no more calls are begun, and the first is passed on.
void in_threads(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace cloth
