// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/iwan.hpp"
#include "fem/material/soil_curve.hpp"

#include <optional>

namespace isostat
{
/// tau/tau_max of virgin loading at x = gamma/gamma_r, and the damping ratio of the Masing loop of that amplitude [-]
double stress_ratio(const Backbone &backbone, double x);
double masing_damping(const Backbone &backbone, double x);

/// Largest strain at which a backbone follows a table: its last one, 1 %, where its stress reaches 0.9 of the strength,
/// or where it stops rising, whichever is least.   @param reference_strain  tau_max/G
double followed_strain(const SoilCurve &curve, double reference_strain);

/// Elements that follow tau = G gamma (G/G_max) of a table up to followed_strain(), then a hyperbola that begins with
/// the slope of the table and tends to the strength, which is reached at a strain of 1 at the latest. (The general
/// quadratic/hyperbolic backbone of Groholski et al. 2016, J. Geotech. Geoenviron. Eng. 142, 04016042, goes over to the
/// strength in the same place; its slope may rise there, which elements in parallel cannot follow.) Where the table's
/// stress is not concave, its concave hull. The largest relative error is as small as the number of elements allows.
/// @param reference_strain  gamma_r = tau_max/G   @throws InputError unless 4 <= elements <= 128
Backbone fit_curve(const SoilCurve &curve, double reference_strain, unsigned elements);

/// Factor by which loops are thinner than Masing's, F = p1 - p2 (1 - G_sec/G)^p3, not below 0 nor above 1 (Phillips and
/// Hashash 2009, Soil Dyn. Earthq. Eng. 29, 1143).
struct LoopReduction
{
  double p1 = 1, p2 = 0, p3 = 1;

  double factor(double secant_ratio) const;
};

/// That with the smallest largest error of F D_Masing against D - D_min, D_min that of the smallest strain, up to 1 %
/// or the end of the table (weights by Lawson, in Rice 1964, The approximation of functions).
/// @pre the curve has damping
LoopReduction fit_loop_reduction(const SoilCurve &curve, const Backbone &backbone, double reference_strain);

/// Iwan with the backbone of a table instead of a hyperbola, and loops as thin as it has them. Other than in Iwan:
///
/// - The table is that of shear from the stress in situ. So the deviator n of the normal stresses in situ (K0) is borne
///   next to the elements and uses no strength up. Where p' falls, |n| is scaled back to M p', as an element is. Shear
///   stresses in situ (a slope) are those of virgin loading, as in Iwan.
/// - With a LoopReduction, e the deviatoric strain since virgin soil (that of the shear stress in situ included) and
///   gamma_m the largest |e| so far, docs/theory_column.md (25d),
///
///       s = F s_Iwan + (1 - F) G_sec e,    G_sec = tau(gamma_m)/gamma_m of the backbone at the present p',
///       F = F(G_sec/G)
///
///   In first loading both parts are the backbone. In cycles of constant amplitude the loop has the ends of Masing's
///   and F times its area, as Phillips and Hashash have it. In irregular loading F and G_sec are those of the largest
///   strain so far, not of the current half-cycle: small cycles after a strong one are damped by F(gamma_m) times what
///   Masing's rules give them, and their modulus is F G + (1 - F) G_sec, below G. The second part pulls back to the
///   strain at the start, so less strain remains.
///
/// tested: tests/fem/material/iwan_curve_test.cpp
class IwanOfCurve : public Iwan
{
public:
  /// @throws InputError as Iwan
  IwanOfCurve(const IwanParameters &parameters, const Backbone &backbone, const std::optional<LoopReduction> &reduction,
              std::size_t n_points);

  void set_initial_stress(std::span<const Stress> effective) override;
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  /// Exact while no strain exceeds the largest so far; else that of Iwan, which differs by the straight pieces alone.
  void stiffness(std::span<Stiffness> tangents) const override;

private:
  enum : std::size_t // of a point, behind what Iwan keeps: normal deviator in situ, then with a reduction
  {
    normal,
    strain_now = normal + 2,
    largest = strain_now + 5,
    all
  };
  struct Loop ///< F and G_sec
  {
    double factor = 1, secant = 0;
  };

  double virgin_stress(double strain, double pressure) const;
  double virgin_strain(double stress, double pressure) const;
  Loop loop(double largest_strain, double pressure) const;
  double *more(std::vector<double> &rows, std::size_t point) { return &rows[(point + 1) * stride_ - n_more_]; }
  const double *more(const std::vector<double> &rows, std::size_t point) const
  {
    return &rows[(point + 1) * stride_ - n_more_];
  }

  std::optional<LoopReduction> reduction_;
  std::size_t n_more_;
};
} // namespace isostat
