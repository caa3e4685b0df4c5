#include "kernels/spring_sweep.h"

#include <algorithm>
#include <cassert>

namespace cloth {

std::optional<double> common_mass(const ClothSystem& system) {
  const auto free = std::find_if(system.inverse_mass.begin(), system.inverse_mass.end(),
                                 [](double inverse) { return inverse != 0; });
  if (free == system.inverse_mass.end()) return std::nullopt;
  for (const double inverse : system.inverse_mass)
    if (inverse != 0 && inverse != *free) return std::nullopt;
  const double mass = system.mass[static_cast<std::size_t>(free - system.inverse_mass.begin())];
  for (const double other : system.mass)
    if (other != mass) return std::nullopt;
  return mass;
}

void SpringSweep::copy(const ClothState& from, ClothState& to) {
  const std::size_t size = from.position.size();
  for (Vec3Field* field : {&to.position, &to.velocity})
    if (field->size() != size) *field = Vec3Field(size);
  to.time = from.time, to.step = from.step;
  in_jobs(PassKind::copies, 1, [&](std::size_t, std::size_t, int threads) {
    const auto copy_share = [&](int share) {
      const auto begin_of = [&](int k) {
        return size * static_cast<std::size_t>(k) / static_cast<std::size_t>(threads);
      };
      const std::size_t begin = begin_of(share), count = begin_of(share + 1) - begin;
      const auto copy_field = [&](const Vec3Field& of, Vec3Field& into) {
        std::copy_n(of.x() + begin, count, into.x() + begin);
        std::copy_n(of.y() + begin, count, into.y() + begin);
        std::copy_n(of.z() + begin, count, into.z() + begin);
      };
      copy_field(from.position, to.position);
      copy_field(from.velocity, to.velocity);
    };
    if (threads == 1) return copy_share(0);
    team()->run(threads, copy_share);
  });
}

SpringSweep::Begun SpringSweep::begin_job(PassKind kind, std::size_t passes) {
  if (use_ == ThreadUse::always) return {passes, threads()};
  ThreadChoice& choice = choices_[static_cast<std::size_t>(kind)];
  Begun begun{.threads = choice.next(threads())};
  begun.passes = std::min(passes, static_cast<std::size_t>(choice.at_once()));
  if (choice.wants_time()) begun.at = std::chrono::steady_clock::now();
  return begun;
}

void SpringSweep::end_job(PassKind kind, const Begun& begun) {
  if (use_ == ThreadUse::always) return;
  ThreadChoice& choice = choices_[static_cast<std::size_t>(kind)];
  const double seconds =
      choice.wants_time() ? std::chrono::duration<double>(std::chrono::steady_clock::now() - begun.at).count()
                          : 0;
  choice.took(seconds, static_cast<int>(begun.passes));
}

void SpringSweep::begin_projections(const std::vector<double>&) {
  assert(false && "only where projects()");
}

double SpringSweep::project(double, double, const Vec3Field&, Vec3Field&) {
  assert(false && "only where projects()");
  return 0;
}

}  // namespace cloth
