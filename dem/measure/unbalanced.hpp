// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/measure/live_contacts.hpp"
#include "dem/state/snapshot.hpp"

namespace isostat
{
/// How far the packing is from rest:
///
///     U = mean over grains in contact |sum of contact forces on the grain| / mean over contacts |F|
///
/// Grain-grain and wall contacts, F = fn n + fs; no damping force enters. Grains that touch nothing do not count.
/// YADE averages over them too, hence reads lower by the factor (N - N_floating)/N (checked on a packing of
/// 1,000 grains); with many floating grains, as in liquefied sand, that flatters.
/// @return [-]; 0 in equilibrium and where there are no contacts     cost one addition per contact and side
/// tested: tests/dem/measure/unbalanced_test.cpp (row in balance and not, shear, floating grain, no contacts)
double unbalanced_force(const Snapshot &snapshot);

/// The same of a running assembly.
/// @param action  [F 0 T 0] of each grain, N and N m, weight included     @param gravity  m/s2
/// tested: tests/dem/assembly/assembly_test.cpp (against the above)
double unbalanced_force(const LiveContacts &contacts, const double *action, const Vec3 &gravity);

/// Inertial number I = rate d50 sqrt(rho/p')      GDR MiDi (2004), doi:10.1140/epje/i2003-10153-0
/// @param strain_rate  1/s, its magnitude counts     @param d50  m     @param density  of the grains, kg/m3
/// @param pressure  p', Pa, compression positive
/// @return [-]; infinite where p' <= 0 and the packing is strained: nothing is quasi-static without pressure
/// tested: tests/dem/measure/unbalanced_test.cpp
double inertial_number(double strain_rate, double d50, double density, double pressure);
} // namespace isostat
