// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/contact/history.hpp"
#include "dem/packing.hpp"

#include <string>

namespace isostat
{
/// Per pair and step, J: what sliding and rolling dissipated, what was forgotten when a contact opened, and what the
/// law created because its lever arms in motion (R1, R2) are not those of its forces (R - u/2). Only scenes that ask
/// for the energy balance have one; the loop without it carries neither the arrays nor the arithmetic.
struct DissipationPerPair
{
  AlignedVector<double> sliding, rolling, released, created;
  void resize(std::size_t n)
  {
    for (auto *v : {&sliding, &rolling, &released, &created})
      v->assign(n, 0.0);
  }
};

/// Contact forces of all pairs, added to the grains: the SIMD form of contact_force() in law.hpp.
///
/// `action` holds one cache line per grain, [Fx Fy Fz 0 Tx Ty Tz 0] (N, N m), and is added to. History in `list` is
/// advanced in place. Sums run in the order of the pair list, lane by lane, so a grain's sum is bitwise the same for
/// any vector width of one instruction set and for any number of non-touching pairs in the list.
/// Does not know walls, gravity or damping.
/// @param dt          s
/// @param dissipation nullptr: the loop without energy sums; otherwise resized to the list and overwritten
/// cost: about 120 multiply-adds per pair, with AVX-512 no divide and no root (estimates and Newton steps) and 400
/// bytes of traffic; see benchmarks/README.md
/// tested: tests/dem/contact/kernel_test.cpp (against the scalar twin, 1e-13, every variant and instruction set)
void add_contact_forces(const LawParams &law, const Packing &packing, double dt, ContactList &list, double *action,
                        DissipationPerPair *dissipation = nullptr);

/// Name of the instruction set that add_contact_forces uses on this machine, e.g. "AVX3".
std::string instruction_set();
} // namespace isostat
