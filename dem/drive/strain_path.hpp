// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "dem/domain/rigid_box.hpp"

namespace isostat
{
/// A box under prescribed logarithmic strain: edge_k = edge_k,0 exp(eps_k) about a fixed centre. The box is set from
/// the total strain, never from products of increments, so that its volume is V_0 exp(eps_x+eps_y+eps_z) to round-off
/// after any number of steps.
/// tested: tests/dem/drive/strain_path_test.cpp (volume to 1e-12 over 1e6 steps)
struct StrainPath
{
  RigidBox reference;

  /// @param strain  logarithmic, along x, y, z, tension positive [-]
  RigidBox box(const Vec3 &strain) const
  {
    const Vec3 half = 0.5 * reference.edges().cwiseProduct(strain.array().exp().matrix());
    return {reference.centre() - half, reference.centre() + half};
  }
};

/// Strain of constant volume for an axial compression: (axial/2, -axial, axial/2); the sum is exactly 0.
inline Vec3 isochoric(double axial_compression)
{
  return {0.5 * axial_compression, -axial_compression, 0.5 * axial_compression};
}
} // namespace isostat
