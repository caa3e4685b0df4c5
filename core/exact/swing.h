// Small swings of what hangs: frequencies, and the logarithmic decrement under damping in proportion to mass.
#pragma once

namespace cloth::exact {

/// First circular frequency (rad/s) of a chain or of cloth without bending stiffness that hangs from one end:
/// j/2 sqrt(g/L), j = 2.404826 the first zero of J_0 (Bernoulli 1738). L in m.
double hanging_chain_frequency(double length, double gravity);

/// Of a point mass on a massless thread: sqrt(g/L), rad/s.
double pendulum_frequency(double length, double gravity);

struct DampedSwing {
  double frequency = 0;  ///< rad/s, with damping
  double decrement = 0;  ///< logarithm of one swing's amplitude over the next one's, a period later
};

/// x'' + c x' + w^2 x = 0 for every mode of its own where damping is a rate c (1/s) times momentum: frequency
/// sqrt(w^2 - c^2/4), decrement pi c/frequency (Meirovitch 1986). Needs c < 2 w.
DampedSwing damped_swing(double undamped_frequency, double mass_damping);

/// The rate c (1/s) from two amplitudes so many periods apart and the damped frequency (rad/s).
double mass_damping_of(double first_amplitude, double last_amplitude, int periods, double frequency);

}  // namespace cloth::exact
