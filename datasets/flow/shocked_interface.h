#pragma once

#include "datasets/flow/mixture.h"

namespace adamas::datasets {

/// An ideal gas at rest with its density.
struct RestingGas {
  StiffenedGas gas;  ///< without stiffness
  double density = 0;
};

/// A shock that comes through one gas to a plane interface with another, denser one: the states before and
/// after by the Rankine-Hugoniot relations. Both gases are at rest at first. Speeds are in the direction of
/// the shock.
struct ShockedInterface {
  double shock_speed = 0;        ///< speed of the shock before it meets the interface
  double shock_density = 0;      ///< density of the first gas behind the shock
  double shock_velocity = 0;     ///< velocity of the first gas behind the shock
  double shock_pressure = 0;     ///< pressure of the first gas behind the shock
  double velocity = 0;           ///< velocity of the interface after the shock
  double pressure = 0;           ///< pressure on both sides of the interface
  double reflected_density = 0;  ///< density of the first gas behind the reflected shock
  double reflected_speed = 0;    ///< speed of the reflected shock
  double through_density = 0;    ///< density of the second gas behind the transmitted shock
  double through_speed = 0;      ///< speed of the transmitted shock
};

/// `mach`, above 1, is the shock's speed relative to the speed of sound in the first gas.
ShockedInterface strike_interface(const RestingGas& first, const RestingGas& second, double pressure,
                                  double mach);

}  // namespace adamas::datasets
