// SPDX-License-Identifier: BSD-3-Clause
// Your own material in a soil column: shear stress follows a hyperbola, tau = G gamma / (1 + |gamma| / gamma_r)
// (Kondner 1963), in each plane by itself and without hysteresis. What to see: under the same wavelet five times as
// strong the displacement of the surface grows by another factor than five, as the soil softens.
#include "fem/libraries.hpp"
#include "fem/material/elastic.hpp"
#include "fem/solve/dynamics.hpp"

#include <cmath>
#include <fmt/format.h>

using namespace isostat;

/// Elastic except for the shear stresses yz and xz. The state is that of Elastic, whose shear stress counts the strain.
class Hyperbolic : public Elastic
{
public:
  Hyperbolic(const ElasticParameters &soil, double reference_strain, std::size_t n_points)
      : Elastic(soil, n_points), limit_(soil.shear_modulus * reference_strain)
  {}
  std::string name() const override { return "hyperbolic"; }
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override
  {
    Elastic::trial(increments, stresses);
    for (Stress &stress : stresses)
      for (int c : {3, 4})
        stress[c] /= 1 + std::abs(stress[c]) / limit_;
  }

private:
  double limit_; ///< shear strength G gamma_r, Pa
};

/// Peak displacement of the surface relative to the base, m.
double peak_displacement(double peak_acceleration)
{
  const double height = 20, density = 2000, velocity = 200;
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "sand", .thickness = height, .density = density, .cells = 20}};
  const Discretisation<1> space(mesh, shaken_supports(false));
  Hyperbolic material({.shear_modulus = density * velocity * velocity, .poisson_ratio = 0.3}, 1e-3, space.n_points());
  material.set_initial_stress(std::vector<Stress>(space.n_points(), Stress{}));
  DynamicsSettings settings;
  settings.motion[0] = ricker_motion(peak_acceleration, 2.5, 0.6, 1e-3);
  Dynamics run(space, material, settings);
  double peak = 0;
  for (const long top = space.find_dof({0, 0, height}, 0); run.time() < 3; run.step())
    peak = std::max(peak, std::abs(run.displacement().local_element(top)));
  return peak;
}

int main()
{
  const Libraries libraries;
  const double weak = peak_displacement(1), strong = peak_displacement(5);
  fmt::print("surface, weak: {:.3f} mm, strong: {:.3f} mm, ratio {:.2f}\n", 1e3 * weak, 1e3 * strong, strong / weak);
}
