// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/virial.hpp"
#include "dem/law/law.hpp"
#include "dem/state/contact_list.hpp"
#include "dem/state/packing.hpp"

#include <algorithm>
#include <string>

namespace isostat
{
/// Per pair and step, J: what sliding, rolling and the dashpot dissipated, what was forgotten when a contact opened,
/// and what the law created because its lever arms in motion (R1, R2) are not those of its forces (R - u/2). Only
/// scenes that ask for the energy balance have one; the loop without it carries neither the arrays nor the arithmetic.
struct DissipationPerPair
{
  AlignedVector<double> sliding, rolling, released, created, viscous;
  void resize(std::size_t n)
  {
    for (auto *v : {&sliding, &rolling, &released, &created, &viscous})
      v->resize(n);
  }
  void clear(std::size_t begin, std::size_t end)
  {
    for (auto *v : {&sliding, &rolling, &released, &created, &viscous})
      std::fill(v->begin() + begin, v->begin() + end, 0.0);
  }
};

/// What the loop needs of a periodic cell in motion.
struct CellMotion
{
  Mat3 strain_step; ///< E = D dt, symmetric [-]: adds D b to the relative velocity of the fluctuations
  Virial *virial;   ///< sums of F b, added to
};

/// Plain view of one chunk, all that a law's loop (loop-inl.hpp) reads and writes.
struct LoopView
{
  const double *position, *velocity, *spin; ///< records of the packing
  const std::uint32_t *first, *second, *target;
  double *history, *action;
  std::uint8_t *occupied;
  std::size_t begin, end;                                                                 ///< blocks
  double dt;                                                                              ///< s
  double contact_damping = 0;                                                             ///< beta of the dashpots [-]
  double *sliding = nullptr, *rolling = nullptr, *released = nullptr, *created = nullptr; ///< null: no energy sums
  double *viscous = nullptr;
  // periodic cell only
  const std::uint32_t *image = nullptr;
  const double *offsets = nullptr;
  double rate[6] = {}; ///< D: xx yy zz yz xz xy, 1/s
  double *virial = nullptr, virial_start = 0;
};

/// Contact forces of the pairs of one chunk, added to the slots of their grains, by any law.
///
/// `action` holds one cache line per slot, [Fx Fy Fz 0 Tx Ty Tz 0] (N, N m), and is added to. History in `list` is
/// advanced in place. Sums run in the order of the pair list, lane by lane, so a grain's sum is bitwise the same for
/// any vector width of one instruction set, any number of non-touching pairs in the list and any number of threads:
/// chunks write to different slots and may run at the same time. Does not know walls, gravity or damping.
/// @param dt          s
/// @param action      list.n_slots() lines
/// @param dissipation nullptr: the loop without energy sums; otherwise as large as the list, its part is overwritten
/// @pre               the layout of the list is law.history()
/// @param contact_damping  beta of dashpots, dem/contact/dashpot.hpp; 0: the loop without them
/// @param cell        of a list with images: branch vectors end at the image, the velocities of `packing` are
///                    fluctuations, and the virial is summed; 26 vector operations more. nullptr in a box
/// cost, linear-rolling: about 190 vector operations for eight pairs and 120 to bring grains in and forces out; with
/// AVX-512 no divide and no root (estimates and series); 400 bytes of traffic per pair; see benchmarks/README.md
/// tested: tests/dem/contact/loop_test.cpp (against the scalar twin, 1e-13, every variant and instruction set)
void add_contact_forces(const ContactLaw &law, const Packing &packing, double dt, ContactList &list, std::size_t chunk,
                        double *action, DissipationPerPair *dissipation, const CellMotion *cell = nullptr,
                        double contact_damping = 0);

/// Adds to the grains of a chunk what other chunks have left in their ghosts, and clears the ghosts.
void add_ghosts(const ContactList &list, std::size_t chunk, double *action);

/// Both for all chunks, one after the other; resizes `dissipation`.
void add_contact_forces(const ContactLaw &law, const Packing &packing, double dt, ContactList &list, double *action,
                        DissipationPerPair *dissipation = nullptr, const CellMotion *cell = nullptr,
                        double contact_damping = 0);
} // namespace isostat
