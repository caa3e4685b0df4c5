// The experiments behind the errata of the source report: plain functions that return numbers.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace cloth {

using Curve = std::vector<std::pair<double, double>>;

/// Runge-Kutta 4 with weights 1, 2, w, 1 (over 6) on x' = -x and on the oscillator x'' = -x.
struct WeightedRungeKutta {
  double decay_error = 0;  ///< |x(1) - exp(-1)| of x' = -x with 320 steps
  double turns = 0;        ///< of the oscillator in one period, 1000 steps
  Curve position;          ///< of the oscillator over two periods, time in periods
};
WeightedRungeKutta weighted_runge_kutta(double third_weight);

/// Errors in m of a 6 x 6 cloth with viscous damping, drag and wind after 0.4 s.
struct MethodErrors {
  std::string name;
  int order = 0;  ///< expected; 0: does not converge
  std::vector<double> steps, errors;
  double last_order() const;
};
std::vector<MethodErrors> errors_of_printed_methods();

/// Hooke's law with the current length: every spring has rest length 0.
struct CurrentLengthCloth {
  double pull = 0;          ///< N on a corner of a 10 x 10 cloth at rest, 100 N/m, spacing 0.1 m
  double pull_in_g = 0;     ///< for particles of 10 g
  double start_radius = 0;  ///< m, of the particle farthest from the middle
  double least_radius = 0;  ///< m, where it turns
  double time = 0;          ///< s, until then
  Curve radius;             ///< m over s
};
CurrentLengthCloth current_length_cloth();

/// Displacements of particles found inside a cube of half width 1.
struct CubePush {
  double mean_corner = 0, mean_least = 0;  ///< over the whole cube
  double corner = 0, least = 0;            ///< of a particle 1 % below the top face
};
CubePush cube_push();

/// A particle that has just come 1 mm into a ball and is already on its way out at 1 m/s: its distance from
/// the surface (m) over time (s), with steps of 1 ms and friction coefficient 0.9.
struct Leaving {
  double velocity = 0;   ///< outward, m/s, after the first response
  double time_lost = 0;  ///< s, until it is 1 cm outside, against the right response
  Curve distance;
};
std::pair<Leaving, Leaving> leaving_particle();  ///< as printed; right

}  // namespace cloth
