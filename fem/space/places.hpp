// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/space/unknowns.hpp"

namespace isostat
{
/// Where unknowns are: those on a face, the one nearest to a place, the place of each. All take this rank's own cells.
/// tested: tests/fem/space/discretisation_test.cpp

/// Local unknowns of a face, owned or not; of nodes that are tied the same one several times.
/// @throws InputError  the face is of an axis that is not meshed
template <int dim>
std::vector<unsigned> displacements_on(const Unknowns<dim> &unknowns, FaceComponent of);
template <int dim>
std::vector<unsigned> pressures_on(const Unknowns<dim> &unknowns, Face face);

/// The local unknown of the node nearest to a place, -1 if another rank owns it. Collective.
template <int dim>
long nearest_displacement(const Unknowns<dim> &unknowns, const Place &place, unsigned component);
template <int dim>
long nearest_pressure(const Unknowns<dim> &unknowns, const Place &place);

/// Where the node of each owned displacement unknown is, m; of a tie, the node that stays.
template <int dim>
std::vector<Place> displacement_places(const Unknowns<dim> &unknowns);

/// Area of a face that belongs to each displacement unknown (axes that are not meshed count 1 m), m2: int N_A over the
/// face by Gauss-Lobatto at the nodes.   @throws InputError  the face is of an axis that is not meshed
template <int dim>
Vector area_of(const Unknowns<dim> &unknowns, Face face);
} // namespace isostat
