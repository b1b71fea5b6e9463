// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/formula_soil.hpp"

#include "base/error.hpp"

namespace isostat
{
std::unique_ptr<Material> formula_material(const ColumnLayer &layer, std::size_t n_points)
{
  if (layer.material == LayerMaterial::mohr_coulomb)
    return std::make_unique<MohrCoulomb>(layer.frictional_soil(), n_points);
  return damped_material(layer, n_points);
}

Stress level_stress(const ColumnScene &scene, const SoilProfile &soil, double k0, double z)
{
  const auto [normal, shear] = soil.in_situ(z, scene.load.surcharge);
  return {-k0 * normal, -k0 * normal, -normal, 0, shear, 0};
}

std::optional<WaveModuli> moduli_at(const ColumnLayer &layer, const Stress &stress)
{
  try
    {
      const std::unique_ptr<Material> material = formula_material(layer, 1);
      material->set_initial_stress({&stress, 1});
      std::array<WaveModuli, 1> moduli;
      material->wave_moduli(moduli);
      return moduli[0];
    }
  catch (const InputError &) // which soil_material() meets again
    {
      return {};
    }
}

std::optional<WaveModuli> moduli_in_situ(const ColumnScene &scene, const ColumnLayer &layer, double z)
{
  return moduli_at(layer, level_stress(scene, soil_profile(scene), layer.k0, z));
}
} // namespace isostat
