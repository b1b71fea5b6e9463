// SPDX-License-Identifier: BSD-3-Clause
// What an undrained specimen does under cyclic load, in the terms of
//
//     Vaid & Chern (1985), Cyclic and monotonic undrained response of saturated sands, ASCE
//     Yang & Sze (2011), Cyclic behaviour and resistance of saturated sand under non-symmetrical loading conditions,
//                        Geotechnique 61(1)
//
//     flow                         strain softening: the load falls off a peak while strain runs on in one direction,
//                                  and does not reach its turning point again; under a load that is kept it runs away
//     limited flow                 the same, but the specimen dilates, and the load reaches its turning point after all
//     cyclic mobility              no softening; p' falls to nearly zero for a while in each cycle, strains grow from
//                                  cycle to cycle
//     plastic strain accumulation  neither; strain grows in one direction, mostly without stress reversal
//
// These authors name no number at which a load "falls off". Here it counts as softening when the load has fallen by
// more than a tenth of its amplitude below the peak of its half cycle and has not come back to that peak within 0.1 %
// of axial strain (shear strain gamma 0.15 %). After a turn the load goes through zero on the way to the other side and
// rises from there: p' near zero at small loads, as in cyclic mobility, is no softening.
// tested: tests/dem/drive/stages/cyclic_response_test.cpp
#pragma once
#include "dem/drive/stages/shear.hpp"

namespace isostat
{
constexpr double softening_load = 0.1;      ///< share of the load amplitude [-]
constexpr double softening_gamma = 0.0015;  ///< engineering shear strain, of axial strain 1.5 times as much [-]
constexpr double accumulated_gamma = 0.075; ///< at which tests without liquefaction count as failed: 5 % axially [-]

/// At the start of a cyclic stage. What softened in stages before stays softened until it recovers.
/// @param load  driven, Pa
void begin_response(double load, DriveState &state);
/// At a turn, once the direction has changed.
/// @param at_load  the load reached its turning point; false: the strain did, before it
void turn_response(double load, DriveState &state, bool at_load = true);
/// Each step; adds an event to the verdict when the specimen begins to flow.
/// @param strain  driven, since the start of shearing [-]   @param amplitude  of the load, Pa
void follow_response(double load, double strain, double amplitude, const ShearMode &mode, std::uint64_t step,
                     DriveState &state, Verdict &verdict);

/// The term for it: "flow", "limited flow", "cyclic mobility", "plastic strain accumulation", or "no failure".
/// @param record  at the end of the test   @param mode  of the cyclic stage
const char *response_name(const UndrainedRecord &record, const ShearMode &mode);
/// The load changed its sign in the cyclic stage, by more than a hundredth of its range.
bool reverses_stress(const CyclicResponse &response);
} // namespace isostat
