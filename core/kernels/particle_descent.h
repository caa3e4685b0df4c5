// The storage of VBD's visits by the kernels, and what calls them, on a grid of springs (grid_descent.h) or
// on any cloth (mesh_descent.h). A step is
//
//     descent.begin(...); sweep(), and extrapolate() between two sweeps, as often as wanted;
//     descent.end(velocity)
//
// and with drag, which changes while the cloth turns, set_drag() stands before each sweep. Particles have
// places in the order of visits, with padding between. Threads do not share the work.
#pragma once

#include <array>
#include <vector>

#include "cloth/cloth_system.h"
#include "geometry/aligned.h"
#include "kernels/local_pass.h"

namespace cloth {

class ParticleDescent {
 public:
  ParticleDescent(const ParticleDescent&) = delete;
  ParticleDescent& operator=(const ParticleDescent&) = delete;
  virtual ~ParticleDescent() = default;

  struct Start {
    double step = 0;                  ///< s
    const std::vector<double>& mass;  ///< kg, m of W^-1 = m I + b b^T (integrators/vbd.h); 0 where pinned
    double spring_damping = 0;        ///< N s/m, of every spring
    /// s, damping of springs, bending and triangles over their stiffness; only if takes_elements().
    double stretch_time = 0, bending_time = 0, membrane_time = 0;
    const SliderState* sliders = nullptr;  ///< of the cloth's, only if takes_elements()
    const Vec3Field& position;             ///< m
    const Vec3Field& predicted;            ///< m/s, v*: the velocities where the visits begin
    bool extrapolates = false;             ///< whether extrapolate() may be called
    bool has_drag = false;                 ///< whether set_drag() may be called
  };
  /// Whether springs may have damping of their own and there may be other elements.
  virtual bool takes_elements() const = 0;
  void begin(const Start& start);
  /// b of W^-1, in kg^1/2, and v* with it; positions stay where they are.
  void set_drag(const Vec3Field& drag, const Vec3Field& predicted);

  struct Sums {
    double change = 0;   ///< the largest, squared, of a particle's velocity by a visit, (m/s)^2
    double squares = 0;  ///< their sum
  };
  Sums sweep();
  void extrapolate(double weight);
  void read_positions(Vec3Field& position) const;  ///< m
  /// The velocities at the end: v*, and what particles have moved beside it over the step's length.
  void end(Vec3Field& velocity) const;

 protected:
  using Stored = std::array<AlignedDoubles, 3>;

  /// place_of[i]: of particle i. To be called once by the constructor of a derived class; `fields` is part of
  /// what it hands to its kernel.
  void make_room(std::vector<int> place_of, int places, kernels::DescentFields& fields);
  virtual void begin_visits(const Start& start) = 0;
  virtual void visit_all() = 0;
  virtual void positions_have_moved() {}
  double step() const { return step_; }
  const std::vector<int>& places() const { return place_of_; }
  const kernels::LocalKernels& local_kernels() const { return *local_kernels_; }

  ParticleDescent();

 private:
  void store(const Vec3Field& field, Stored& to) const;

  kernels::DescentFields* fields_ = nullptr;
  const kernels::LocalKernels* local_kernels_;
  std::vector<int> place_of_;
  Stored position_, shift_, start_, before_, present_, drag_;
  AlignedDoubles mass_, free_;
  Vec3Field predicted_;
  double step_ = 0;
};

}  // namespace cloth
