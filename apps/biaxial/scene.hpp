// SPDX-License-Identifier: BSD-3-Clause
// What a run of the biaxial block consists of. Lengths m, stresses Pa.
#pragma once
#include "apps/deposit/scene.hpp"
#include "fem/material/nonlocal.hpp"
#include "fem/solve/newton_settings.hpp"

namespace isostat
{
/// A block in plane strain: x across, z up.
struct BiaxialMesh
{
  double width = 1, height = 2;             ///< m
  unsigned cells_across = 8, cells_up = 16; ///< elements
  unsigned degree = 1;                      ///< of the displacement
  unsigned points = 2;                      ///< Gauss points of an element along each axis

  bool operator==(const BiaxialMesh &) const = default;
};

/// A square of elements that differs from the rest.
struct WeakZone
{
  unsigned cells = 0;           ///< along each side; 0: there is none
  unsigned column = 0, row = 0; ///< of its lower left element, from the lower left corner of the block
  double factor = 0.8;          ///< of stiffness and strength, of a material from a formula
  SpecimenRequest grains;       ///< of packings; a density left out is that of the soil

  bool operator==(const WeakZone &) const = default;
};

/// Confined on its sides, compressed by its top.
struct BiaxialTest
{
  double confinement = 100e3; ///< isotropic effective stress at the start, total stress on the sides throughout, Pa
  double axial_strain = 0.05; ///< at the end, compression positive
  unsigned steps = 50;
  double duration = 100; ///< s; counts only if water moves

  bool operator==(const BiaxialTest &) const = default;
};

enum class BlockDrainage
{
  drained,  ///< no excess pressure
  undrained ///< no water leaves the block
};

/// Water in the pores.
struct BlockWater
{
  BlockDrainage drainage = BlockDrainage::drained;
  double permeability = 0; ///< k inside of the block, m/s; 0: water stays where it is
  double porosity = 0.4;

  bool undrained() const { return drainage == BlockDrainage::undrained; }
  bool operator==(const BlockWater &) const = default;
};

struct BiaxialOutput
{
  std::string folder;     ///< default: results/<scene file name>
  unsigned map_every = 5; ///< steps between two maps
  double checkpoint_minutes = 5;

  bool operator==(const BiaxialOutput &) const = default;
};

/// A whole run: what a scene file says after defaults, overrides and checks.
struct BiaxialScene
{
  std::string title;
  BiaxialMesh mesh;
  ColumnLayer soil; ///< its material; no thickness or weight
  RveMaterialSettings grains;
  NonlocalParameters nonlocal; ///< of all of the soil; length 0: it is local
  WeakZone weak;
  BlockWater water;
  BiaxialTest test;
  NewtonSettings newton{.tolerance = 1e-6, .max_halvings = 8}; ///< the smallest force scale is confinement times width
  BiaxialOutput output;

  bool has_grains() const { return soil.material == LayerMaterial::grains; }
  bool operator==(const BiaxialScene &) const = default;
};

/// Reads and checks a scene file. A relative library is looked for as found_file() does; an output folder left
/// out becomes results/<scene file name without ending>.
/// @param overrides  "a.b=c" from --set
/// @throws InputError with file:line, value, allowed range and remedy   tested: tests/apps/biaxial_test.py
BiaxialScene read_biaxial_scene(const std::string &path, const std::vector<std::string> &overrides = {});

/// The same from text, without a look at the disk; `name` stands for the file in messages.
BiaxialScene parse_biaxial_scene(const std::string &text, const std::string &name);

const SceneSchema &biaxial_schema();
std::string to_toml(const BiaxialScene &scene); ///< complete; reads back to the same scene
std::string default_biaxial_scene();            ///< commented, with all defaults, units and ranges
std::string biaxial_scene_manual();             ///< docs/biaxial_scene_reference.md
} // namespace isostat
