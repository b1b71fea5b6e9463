// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "coupling/in_situ/specimen_request.hpp"
#include "fem/material/nonlocal.hpp"
#include "fem/space/axes.hpp"

namespace isostat
{
class SceneDocument;
struct ColumnLayer;
struct ColumnScene;

/// A square of elements that differs from the rest.
struct WeakZone
{
  unsigned cells = 0;           ///< along each side; 0: there is none
  unsigned column = 0, row = 0; ///< of its lower left element, from the lower left corner of the block
  double factor = 0.8;          ///< of stiffness and strength, of a material from a formula
  SpecimenRequest grains;       ///< of packings; a density left out is that of the soil

  bool operator==(const WeakZone &) const = default;
};

/// A block of soil without weight in plane strain, confined on its sides, compressed by its top, smooth as its base; no
/// water leaves it.
struct Biaxial
{
  double confinement = 100e3;  ///< isotropic effective stress at the start, total stress on the sides throughout, Pa
  double axial_strain = 0.05;  ///< at the end, compression positive
  double duration = 100;       ///< s; counts only if water moves
  unsigned map_every = 5;      ///< steps between two maps
  NonlocalParameters nonlocal; ///< of all of the soil; length 0: it is local
  WeakZone weak;

  bool operator==(const Biaxial &) const = default;
};

/// The keys of [analysis].   tested: tests/apps/deposit/box_test.cpp
SceneFragment<Biaxial> biaxial_keys();

unsigned cells_up(const ColumnScene &scene); ///< elements along z
/// True where a point lies in the weak zone of a block.
bool in_weak_zone(const ColumnScene &scene, const Place &place);
/// What a layer is there.
ColumnLayer weakened(const ColumnLayer &layer, const WeakZone &weak);

/// Rules of a block, and of what has no effect on one.
/// @throws InputError   tested: tests/apps/deposit/box_test.cpp
void check_biaxial(const SceneDocument &document, const ColumnScene &scene);
} // namespace isostat
