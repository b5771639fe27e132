#pragma once

namespace adamas::test {

/// A state of a stiffened gas, p = (gamma - 1) rho e - gamma stiffness.
struct GasState {
  double density = 1, velocity = 0, pressure = 1;
  double gamma = 1.4, stiffness = 0;
};

/// The exact solution of the Riemann problem of two stiffened gases that do not mix: a shock or a rarefaction
/// in each, and the contact between them (Toro's book, chapter 4, with p + stiffness in place of p).
class ExactRiemann {
 public:
  ExactRiemann(const GasState& left, const GasState& right);

  [[nodiscard]] double pressure() const { return pressure_; }
  [[nodiscard]] double velocity() const { return velocity_; }
  /// Returns the state on the line of this x / t.
  [[nodiscard]] GasState at(double speed) const;

 private:
  GasState left_, right_;
  double pressure_ = 0, velocity_ = 0;
};

}  // namespace adamas::test
