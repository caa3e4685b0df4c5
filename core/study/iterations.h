// How the iterations of the methods that solve an implicit Euler step converge: one step of a scene in
// motion, solved with more and more iterations. Measured is the objective of the step,
//
//     G(x') = sum_i M_i/(2 h^2) |x'_i - y_i|^2 + E(x'),   M_i = m_i + h c_i,   y = x + h (m v + h m g)/M
//
// E the energy of springs, bending and membrane, c viscous damping, as (G - G*)/(G_0 - G*), with G_0 at y and
// G* at the solution of Newton's method. What has no potential or is no part of a step's equations (dampers
// of elements, air, hysteresis, limits, contact) is left out of the scene and named.
//
//     const IterationsStudy study = run_iterations_study(scene, {.time = 0.2});
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "params/problem.h"
#include "scene/scene.h"
#include "study/study_progress.h"

namespace cloth {

struct IterationsStudy;

struct IterationsOptions {
  std::vector<std::string> methods{};  ///< of iterated_methods(); empty: all
  std::optional<double> step{};        ///< s; none: the scene's, or 1/100 where that is auto
  double time = 0.25;                  ///< s, of motion before the step that is studied
  int most = 1000;                     ///< iterations
  int repeats = 5;                     ///< timed solves of each number of iterations; the least counts
  double budget = 60;                  ///< s of each method; it takes no longer rung beyond
  std::function<bool(const StudyProgress&)> progress{};  ///< false stops the study
  /// The study so far, after every step.
  std::function<void(const IterationsStudy&)> partial{};
  StopTest stop{};
  /// The same study, stopped before its end: its finished methods are not measured again.
  const IterationsStudy* earlier = nullptr;
};

/// A step solved with so many iterations.
struct IteratedStep {
  int iterations = 0;
  double seconds = 0;    ///< the least, of the whole step
  double objective = 0;  ///< (G - G*)/(G_0 - G*); not a number where the step failed
};

struct MethodIterations {
  std::string method;
  std::vector<IteratedStep> steps{};
  std::string remark{};  ///< why it went no further
};

struct IterationsStudy {
  Scene scene;                          ///< as studied
  std::vector<std::string> left_out{};  ///< of the scene as it was, a clause each
  std::vector<std::string> asked{};     ///< methods, in their order
  double asked_time = 0;                ///< s, of motion before the step; it is reached in whole steps
  int most = 0;                         ///< iterations
  double time = 0, step = 0;            ///< s
  int particles = 0;
  std::string failure{};    ///< why there is nothing to measure against; empty: there is
  double fall = 0;          ///< J, G_0 - G*
  double residual = 0;      ///< largest of m (v' - v) - h f at the solution, N s
  bool is_minimum = false;  ///< the second derivative of G is positive definite there
  /// Differences of G that mean nothing, over `fall`: the largest of what two solutions from different
  /// guesses differ by and of what moving the solution by rounding alone changes.
  double floor = 0;
  std::vector<MethodIterations> methods{};
  bool stopped = false;
  bool is_complete() const;
};

/// implicit-euler (Newton's method), projective, xpbd, vbd.
const std::vector<std::string>& iterated_methods();

/// Whether nothing more is to be measured of a method, of at most so many iterations.
bool is_finished(const MethodIterations& method, int most);

/// Precondition of what follows: find_problems(scene) is empty.
std::vector<Problem> find_problems(const Scene& scene, const IterationsOptions& options);

/// The scene as it is studied, and what was left out of it.
Scene scene_of_iterations(const Scene& scene, std::vector<std::string>& left_out);

/// The study without what is measured. Precondition of both: find_problems is empty.
IterationsStudy plan_iterations_study(const Scene& scene, const IterationsOptions& options);
IterationsStudy run_iterations_study(const Scene& scene, const IterationsOptions& options);

/// The scene with every step solved as this one.
Scene scene_of(const IterationsStudy& study, const MethodIterations& method, const IteratedStep& step);

/// The first step of a method whose objective is at most this; null: none.
const IteratedStep* first_below(const MethodIterations& method, double objective);

}  // namespace cloth
