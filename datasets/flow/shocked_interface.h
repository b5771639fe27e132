#pragma once

#include "datasets/flow/stiffened_gas.h"

namespace adamas::datasets {

/// An ideal gas with its density at rest.
struct RestingGas {
  StiffenedGas gas;  ///< without stiffness
  double density = 0;
};

/// A shock that comes through one gas to a plane interface with another one, which is the denser: what the
/// Rankine-Hugoniot relations say of it before and after. Both gases are at rest at first. Speeds are along
/// the shock's way.
struct ShockedInterface {
  double shock_speed = 0;        ///< before it meets the interface
  double shock_density = 0;      ///< of the first gas behind it,
  double shock_velocity = 0;     ///< and its velocity,
  double shock_pressure = 0;     ///< and its pressure
  double velocity = 0;           ///< of the interface, once it is struck,
  double pressure = 0;           ///< and the pressure on both sides of it
  double reflected_density = 0;  ///< of the first gas behind the shock that the interface throws back
  double reflected_speed = 0;    ///< of that shock
  double through_density = 0;    ///< of the second gas behind the shock that went through
  double through_speed = 0;      ///< of that shock
};

/// `mach`, above 1, is the shock's speed over that of sound in the first gas.
ShockedInterface strike_interface(const RestingGas& first, const RestingGas& second, double pressure,
                                  double mach);

}  // namespace adamas::datasets
