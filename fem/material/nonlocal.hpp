// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/averaging.hpp"
#include "fem/material/outer_material.hpp"

namespace isostat
{
/// A length for a material that has none: docs/theory_column.md (18b) to (18d).
struct NonlocalParameters
{
  double length = 0;    ///< l, standard deviation of the weights of averages along an axis, m; 0: the material is local
  double stiffness = 1; ///< of the stress against differences of strain, over the wave moduli at the start [-]; >= 0

  bool operator==(const NonlocalParameters &) const = default;
};

/// Any material, made nonlocal: it is given the mean W dh of the increments of displacement gradient around each point,
/// and what the strain differs from its mean is borne by an elastic stress s next to it,
///
///     sigma = W sigma_in(W dh) + (I - W) s            ds = A : (I - W) d eps,   A isotropic, fixed at the start
///
/// the derivative of sum_q w_q [psi(W eps) + (eps - W eps) : A : (eps - W eps) / 2]: where the inner stress has a
/// potential psi, so has this one, and its tangent is symmetric. Uniform strain is answered as by the inner material,
/// to round-off. A band in which strain gathers cannot be thinner than some l, whatever the mesh, if its points are
/// nearer than l (Polizzotto, Fuschi & Pisano 2006, Eur. J. Mech. A/Solids 25, 308; Bazant & Jirasek 2002, J. Eng.
/// Mech. 128, 1119). Strain and differences of strain are small ones of the undeformed mesh.
///
/// State: that of the inner material, s and A. All points of the body must be here: a mesh that is shared out over
/// ranks has no nonlocal material.
/// tested: tests/fem/material/nonlocal_test.cpp, tests/verification/nonlocal_column_test.cpp
class Nonlocal : public OuterMaterial
{
public:
  /// A is 0 until the initial stress is set: it follows from the wave moduli that the inner material has then.
  /// @param positions, volumes  of the points of the inner material, m, m3
  /// @throws InputError  parameters out of range, other numbers of points, as Averaging
  Nonlocal(std::unique_ptr<Material> inner, const NonlocalParameters &parameters,
           std::span<const std::array<double, 3>> positions, std::span<const double> volumes);

  /// s begins with the initial stress as the inner material does: any field of it is kept, not only a uniform one.
  void set_initial_stress(std::span<const Stress> effective) override;
  /// The same where the inner material has been brought to these stresses already.
  void start_from(std::span<const Stress> effective);
  /// Cost: besides the inner material's, 15 multiplications for each pair of points nearer than 4 l.
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  /// Elastic, of the wave moduli: the true tangent joins all points nearer than 8 l and is no matter of one of them.
  /// With it Newton's method is that of an initial stiffness, whose residual falls by a steady factor; relaxation is
  /// better.
  void stiffness(std::span<Stiffness> tangents) const override;
  /// The larger of A's and the mean W of the inner material's. With both the same everywhere it bounds the work of any
  /// field, since W has its eigenvalues g between 0 and 1, where g^2 C + (1 - g)^2 A is at most the larger of C and A.
  void wave_moduli(std::span<WaveModuli> moduli) const override;

  /// What the inner material gets of a field of gradients.
  void average(std::span<const Gradient> gradients, std::span<Gradient> means) const { mean_.apply(gradients, means); }

private:
  enum Row : std::size_t ///< of a point: s in Pa, and the moduli of A in Pa
  {
    at_bulk = 6,
    at_shear,
    row_size
  };
  void find_moduli();

  NonlocalParameters parameters_;
  Averaging mean_;
  std::vector<Gradient> increments_; ///< of one trial: W dh
  std::vector<Stress> inner_stresses_, excess_;
};
} // namespace isostat
