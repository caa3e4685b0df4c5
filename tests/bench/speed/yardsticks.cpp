#include "bench/speed/yardsticks.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "bench/speed/scalar_roots.h"
#include "kernels/kernel_table.h"
#include "kernels/worker_team.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define CLOTHLAB_FOR_TARGET(name) __attribute__((target(name)))
#endif

namespace cloth::speed {
namespace {

// One loop, compiled for each instruction set: inlined into a function of that target, it is vectorised for
// it.
CLOTHLAB_INLINE void roots(const double* __restrict x, double* __restrict y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) y[i] = 1 / std::sqrt(x[i]);
}

void baseline_roots(const double* x, double* y, std::size_t count) {
  roots(x, y, count);
}

#ifdef CLOTHLAB_FOR_TARGET
CLOTHLAB_FOR_TARGET("avx2") void avx2_roots(const double* x, double* y, std::size_t count) {
  roots(x, y, count);
}

CLOTHLAB_FOR_TARGET("avx512f,prefer-vector-width=512")
void avx512_roots(const double* x, double* y, std::size_t count) {
  roots(x, y, count);
}
#endif

struct VectorRoots {
  const char* name;
  void (*run)(const double*, double*, std::size_t);
};

VectorRoots widest_roots() {
#ifdef CLOTHLAB_FOR_TARGET
  if (__builtin_cpu_supports("avx512f")) return {"AVX-512", avx512_roots};
  if (__builtin_cpu_supports("avx2")) return {"AVX2", avx2_roots};
#endif
  return {"baseline", baseline_roots};
}

std::size_t default_array_bytes() {
  constexpr std::size_t least = std::size_t{64} << 20, most = std::size_t{512} << 20;
  long cache = 0;
#ifdef _SC_LEVEL3_CACHE_SIZE
  cache = sysconf(_SC_LEVEL3_CACHE_SIZE);  // 0 or -1 where the system does not tell
#endif
  return std::clamp(4 * static_cast<std::size_t>(std::max(cache, 0L)), least, most);
}

/// The compiler may not leave out what wrote `data`.
void keep(const void* data) {
#ifdef __GNUC__
  asm volatile("" : : "r"(data) : "memory");
#else
  static const void* volatile sink;
  sink = data;
#endif
}

}  // namespace

Yardsticks measure_yardsticks(const YardstickPlan& plan, const TimingProgress& progress) {
  Yardsticks result;
  result.array_bytes = plan.array_bytes > 0 ? plan.array_bytes : default_array_bytes();
  const VectorRoots vector = widest_roots();
  result.vectors = vector.name;

  constexpr std::size_t few = 1024;  // stays in the first cache
  std::vector<double> x(few), y(few);
  for (std::size_t i = 0; i < few; ++i) x[i] = 0.5 + 1e-3 * static_cast<double>(i);
  const std::size_t many = std::max<std::size_t>(1, result.array_bytes / sizeof(double));
  std::vector<double> a(many, 0.0), b(many, 1.0), c(many, 2.0);
  constexpr double s = 1e-9;

  const auto subject = [](const char* name, std::size_t elements, auto work) {
    return Subject{name, 1e9 / static_cast<double>(elements), [work](int times) {
                     for (int k = 0; k < times; ++k) work();
                     return true;
                   }};
  };
  std::vector<Subject> subjects;
  subjects.push_back(subject("scalar roots", few, [&] {
    scalar_roots(x.data(), y.data(), few);
    keep(y.data());
  }));
  subjects.push_back(subject("vector roots", few, [&, vector] {
    vector.run(x.data(), y.data(), few);
    keep(y.data());
  }));
  subjects.push_back(subject("triad", many, [&] {
    double* __restrict to = a.data();
    for (std::size_t i = 0; i < many; ++i) to[i] = b[i] + s * c[i];
    keep(to);
  }));
  subjects.push_back(subject("update in place", many, [&] {
    double* __restrict to = a.data();
    for (std::size_t i = 0; i < many; ++i) to[i] += s * c[i];
    keep(to);
  }));
  result.cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  WorkerTeam team(result.cores);
  constexpr int passes = 100;  // a job is then long beside waking the threads
  std::vector<std::vector<double>> own(static_cast<std::size_t>(result.cores), std::vector<double>(few));
  subjects.push_back(subject("vector roots on every core", few * passes, [&, vector] {
    team.run(team.size(), [&](int share) {
      double* to = own[static_cast<std::size_t>(share)].data();
      for (int k = 0; k < passes; ++k) vector.run(x.data(), to, few), keep(to);
    });
  }));
  subjects.back().threads = result.cores;
  if (!time_interleaved(subjects, plan.timing, progress)) return result;
  result.scalar_root = spread_of(subjects[0]);
  result.vector_root = spread_of(subjects[1]);
  result.triad = spread_of(subjects[2]);
  result.update = spread_of(subjects[3]);
  result.together = ratio_of(subjects[1], subjects[4]);
  for (double* gain :
       {&result.together.low, &result.together.median, &result.together.high, &result.together.least})
    *gain *= result.cores;
  return result;
}

double divider_floor(const Yardsticks& yardsticks, double springs_per_particle, double evaluations) {
  return yardsticks.vector_root.median * springs_per_particle * evaluations;
}

double memory_floor(const Yardsticks& yardsticks) {
  constexpr double bytes = 2 * 6 * sizeof(double);  // six numbers read and written
  return bytes / Yardsticks::bytes_per_element * yardsticks.update.median;
}

}  // namespace cloth::speed
