// SPDX-License-Identifier: BSD-3-Clause
// One sub-step of statics by relaxation: docs/theory_column.md (18a). A body without inertia of its own is given one whose
// mass matrix is an elastic stiffness M, and falls to rest under its residual. With M no softer than the soil all modes
// have frequencies of at most 1, so one step suits all, in any mesh; soft modes speed up until their power changes its
// sign, and start anew from rest.
//
//     s_k = M^-1 r(y_k)         x_k+1 = y_k + s_k          y_k+1 = x_k+1 + (t_k - 1)/t_k+1 (x_k+1 - x_k)
//     t_k+1 = [1 + sqrt(1 + 4 t_k^2)]/2;  t = 1 and y = x where r(y_k).(x_k+1 - x_k) <= 0
//
// Nesterov 1983 with the restart of O'Donoghue & Candes (2015), Adaptive restart for accelerated gradient schemes,
// Found. Comput. Math. 15; in mechanics, dynamic relaxation with kinetic damping (Cundall 1976). Strains of every y are
// tried from the committed state, so a material that remembers its path remembers the straight one to the equilibrium,
// not the wanderings of the relaxation.
#include "fem/material/elastic.hpp"
#include "fem/solve/statics.hpp"
#include "fem/solve/statics_system.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace isostat
{
/// M: elastic, isotropic, from the moduli of waves, which are rather too large.
void Statics::set_metric()
{
  std::vector<WaveModuli> moduli(material_.n_points());
  material_.wave_moduli(moduli);
  for (std::size_t q = 0; q < moduli.size(); ++q)
    tangents_[q] = isotropic_stiffness(std::max(moduli[q].p - 4.0 / 3 * moduli[q].s, moduli[q].s / 3), moduli[q].s);
  system_->set_tangent(tangents_, theta_);
}

/// r.(x - x'), x' in start_du_, over free unknowns. J
double Statics::power() const
{
  double sum = 0;
  for (std::size_t i = 0; i < is_held_u_.size(); ++i)
    if (!is_held_u_[i])
      sum += r_u_.local_element(i) * (du_.local_element(i) - start_du_.local_element(i));
  if (space_.shared_out())
    MPI_Allreduce(MPI_IN_PLACE, &sum, 1, MPI_DOUBLE, MPI_SUM, space_.communicator());
  return sum;
}

/// True if it found equilibrium; else reason_ says why not.
bool Statics::relax_substep(double duration)
{
  const unsigned most = settings_.newton.relaxation_iterations;
  start_substep(duration);
  set_metric();
  start_du_ = du_;
  start_dp_ = dp_;
  double t = 1;
  for (unsigned iteration = 0;; ++iteration)
    {
      if (left_ == 0 && merit(0) <= settings_.newton.tolerance * trial_scale_)
        return true;
      if (iteration == most)
        break;
      find_step();
      du_ += step_u_;
      dp_ += step_p_;
      const bool downhill = left_ > 0 || power() > 0; // the first step moves what is held
      left_ = 0;
      const double next = downhill ? 0.5 * (1 + std::sqrt(1 + 4 * t * t)) : 1, carried = downhill ? (t - 1) / next : 0;
      t = next;
      const auto carry = [carried](Vector &now, Vector &before) {
        for (std::size_t i = 0; i < now.locally_owned_size(); ++i)
          {
            const double x = now.local_element(i);
            now.local_element(i) = x + carried * (x - before.local_element(i));
            before.local_element(i) = x;
          }
      };
      carry(du_, start_du_);
      if (water_)
        carry(dp_, start_dp_);
      if (!evaluate())
        return false;
      residual_ = merit(0) / trial_scale_;
    }
  reason_ = fmt::format("relaxation has not come to rest in {} iterations", most);
  return false;
}
} // namespace isostat
