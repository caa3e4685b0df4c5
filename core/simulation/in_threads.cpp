#include "simulation/in_threads.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace cloth {
namespace {

/// As many threads as there can be, up to `count`; without the others the work only takes longer.
template <class Work>
void begin_threads(std::vector<std::jthread>& threads, std::size_t count, const Work& work) {
  try {
    threads.reserve(count);
    while (threads.size() < count) threads.emplace_back(work);
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
}

}  // namespace

void in_threads(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::exception_ptr thrown;
  std::mutex of_thrown;
  const auto take = [&] {
    try {
      for (std::size_t i = next++; i < count; i = next++) work(i);
    } catch (...) {
      const std::lock_guard lock(of_thrown);
      if (!thrown) thrown = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> others;
    begin_threads(others, std::min(count, static_cast<std::size_t>(std::max(1, threads))) - (count > 0),
                  take);
    take();
  }
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace cloth
