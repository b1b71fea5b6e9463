// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "fem/material/row_material.hpp"

namespace isostat
{
/// A sand for Iwan. p' is the mean effective stress, compression positive; tau = sqrt(J2) is the shear stress of simple
/// shear; eta = tau/p'. The defaults are a loose sand. Ranges are in fem/material/iwan_scene.cpp, from which the keys
/// of scenes, the checks and the bytes of Iwan follow.
struct IwanParameters
{
  double shear_modulus = 50e6;             ///< G at small strain and p' = reference_pressure, Pa
  double poisson_ratio = 0.2;              ///< K/G = 2 (1 + nu) / (3 (1 - 2 nu)) at every p' [-]
  double exponent = 0.5;                   ///< n of G = shear_modulus (p'/reference_pressure)^n, in [0, 1] [-]
  double reference_pressure = 100e3;       ///< Pa
  double strength_ratio = 0.55;            ///< M: tau <= M p' [-]
  double phase_transformation_ratio = 0.4; ///< M_pt: contracts below, dilates above [-]
  double contraction = 0.5;                ///< A below M_pt [-]; both A = 0: p' feels no shear
  double dilation = 0.3;                   ///< A above M_pt, in [0, 1] [-]
  double fabric_limit = 8;                 ///< z_max: after much dilation soil contracts 1 + z_max times as fast [-]
  double fabric_rate = 1000;               ///< dz = rate (z_max - z) times strain of dilation [-]
  double critical_pressure = 1e6;          ///< dilation fades as 1 - p'/critical_pressure. Pa
  double residual_ratio = 0.02;            ///< p' never falls below this part of its initial value [-]
  double min_pressure = 200;               ///< nor below this. Pa
  double loosening_limit = 0.01;           ///< volumetric strain kept at most as loosening (see Iwan) [-]
  double contraction_exponent = 0;         ///< m of (22): cycles to liquefaction go with CSR^-(2 + m) [-]
  double reconsolidation = 0;              ///< a of (25c); 0: only loosening and K give volumetric strain [-]
  double substep = 2e-5;                   ///< strain of one sub-step at most [-]
  unsigned elements = 12;                  ///< 4 ... 128; backbone within 1.8 % with 12, 0.05 % with 128

  bool operator==(const IwanParameters &) const = default;
};

/// tau/tau_max = sum over k of weight_k min(x, yield_strain_k), x = strain / gamma_r: a hyperbola in straight pieces.
struct Backbone
{
  std::vector<double> weights;       ///< w_k, they sum up to 1 (initial slope)
  std::vector<double> yield_strains; ///< x_k, log-spaced; sum of w_k x_k = 1 (strength)
};

/// Weights that bring the sum to x/(1 + x) (Hardin and Drnevich 1972): its nodes lie a little above the hyperbola, so
/// that the error is the same in both directions.   @throws InputError unless 4 <= elements <= 128
Backbone fit_hyperbola(unsigned elements);

/// Sand under cyclic shear, of which a column of soil can liquefy without a grain: elements side by side, each elastic
/// and perfectly plastic (Iwan 1967, doi:10.1115/1.3607751; overlay of Besseling 1958), here in the space of deviators,
/// with strength and stiffness that follow p'. With gamma_r = M p'/G, all per volume of soil, docs/theory_column.md:
///
///     (19) element k      s_k = w_k G (gamma - gamma_pk),  |s_k| <= w_k x_k M p'     radial return (von Mises)
///     (20) deviator       s = sum of s_k;  |s| = sqrt(J2),  |gamma| = 2 sqrt(J2 of strain): simple shear's tau, gamma
///     (21) plastic flow   d gamma_p = sum of w_k d gamma_pk
///     (22) volume         d eps_vp = A (M_pt |d gamma_p| - s . d gamma_p / p')       contraction positive;
///                         A = contraction (1 + z) f^m if the bracket is > 0, else dilation max(0, 1 - p'/p_c);
///                         f = |d gamma_p| / |d gamma|
///     (23) fabric         dz = fabric_rate (z_max - z) d(dilation)
///     (24) pressure       d p' = K (d eps_v - d eps_vp)
///     (25) moduli         G, K ~ (p'/p_ref)^n
///     (25c) liquefied     eps_v = a min(0.08, gamma_max) from p' = 0 back to its initial value
///
/// The volume law is Rowe's (1962, doi:10.1098/rspa.1962.0193) stress dilatancy with the stress ratio seen along the
/// flow (Manzari and Dafalias 1997, doi:10.1680/geot.1997.47.2.255): after a reversal it contracts most. What has
/// dilated contracts faster afterwards (the fabric of Dafalias and Manzari 2004,
/// doi:10.1061/(ASCE)0733-9399(2004)130:6(622), here a number z that only grows), else no p' near zero is ever met.
/// Without drainage p' falls cycle by cycle, and rises on the way to the strength: loops like a butterfly. As p' falls,
/// elements are scaled back to their yield; this flow is not counted in the volume law. p' has a floor: contraction (or
/// pulling apart) beyond it is kept as loosening, a strain that must be closed by compression or dilation before p' can
/// rise again. The plastic part f of the strain is 0 after a reversal and grows with the way from it, so that m > 0
/// makes small stresses contract less. With `reconsolidation` a point whose p' has been at a fifth of its
/// initial value (r_u = 0.95 may leave that much) has (25c) (Yoshimine et al. 2006, Soil Dyn. Earthq. Eng. 26, 253) as
/// the volumetric strain of its reconsolidation: what loosening and K do not give is closed by compression, most of it
/// while p' is low, and erases z. gamma_max is the largest |gamma| since it liquefied.
///
/// Tension positive in stresses and strains of the interface. Rotations are not followed: strains are small. There is
/// no critical void ratio: cyclic mobility tends to loops of one size.
/// tested: tests/fem/material/iwan_test.cpp, tests/fem/material/iwan_liquefaction_test.cpp
class Iwan : public RowMaterial
{
public:
  /// Starts at the isotropic stress p' = reference_pressure.
  /// @throws InputError naming a parameter out of its range
  Iwan(const IwanParameters &parameters, std::size_t n_points);

  /// The deviator of the normal stresses is shared out in proportion to the elements' strengths: no element yields at
  /// once, shear begins with G. Shear stresses (a slope) are those of virgin loading at this p': shear further on
  /// follows the backbone, shear back begins with G and is twice as wide (Masing).
  /// @throws InputError naming the point if p' <= 0 or the deviator is above the strength
  void set_initial_stress(std::span<const Stress> effective) override;
  /// @throws RunFailure naming the point if its strain increment is not a number or above 1
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  /// Consistent tangent: differences of the stress update itself at the last trial's increment (relative error 1e-5),
  /// taken forward in the direction of the increment. The elastic stiffness where there was no increment. Not
  /// symmetric; singular at the floor of p'.
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;

  /// p' of the committed state, compression positive. Pa
  double mean_pressure(std::size_t point) const;
  /// Volumetric strain to be closed before p' rises from its floor, committed state. [-]
  double loosening(std::size_t point) const;
  /// G and gamma_r = M p'/G at a pressure. Pa, [-]
  double shear_modulus(double pressure) const;
  double reference_strain(double pressure) const;

protected:
  /// @param numbers  parameters of a derived material   @param n_more  numbers that it keeps at the end of each point's
  /// row, behind p' and the elements; 0 at first
  Iwan(const IwanParameters &parameters, const Backbone &backbone, std::span<const double> numbers, std::size_t n_more,
       std::size_t n_points);
  enum : std::size_t // one point: its numbers, its elements' deviators component by component, then, if it
                     // reconsolidates by (25c), what that needs
  {
    pressure,
    floor_pressure,
    loose,
    fabric,
    deviator,
    elements = deviator + 5
  };
  enum : std::size_t // of the last part
  {
    strain_so_far,
    largest_strain = strain_so_far + 5, // since it liquefied; 0: it did not
    volume,                             // volumetric strain since then, compression positive; of expansion it
    largest_volume,                     // remembers loosening_limit below the largest
    initial_pressure,
    n_reconsolidation
  };
  using Shear = std::array<double, 5>; // deviator in axes that make |s| = sqrt(J2) and |gamma| = gamma of simple shear

  IwanParameters parameters_;
  std::size_t width_, stride_;           // elements with padding; numbers per point
  std::vector<double> weights_, yields_; // w_k, M w_k x_k
  std::vector<Gradient> increments_;     // of the last trial

private:
  static constexpr std::size_t max_elements = 128, lanes = 4;
  static std::size_t padded(std::size_t n_elements) { return (n_elements + lanes - 1) / lanes * lanes; }
  struct Increment
  {
    Shear shear{};
    double volumetric = 0; // contraction positive
    unsigned steps = 0;
  };

  Increment increment(const Gradient &h, std::size_t point) const;
  void integrate(const double *from, const Increment &d, double *to) const;
  void step(const double *from, const Increment &d, double *to) const;
  void change_pressure(const double *from, const Shear &flow, const Increment &d, double shear, double *to) const;
  double reconsolidate(const double *from, const Increment &d, double plastic, double bulk, double *to) const;
  double compression(double from, double to) const; // volumetric strain of K between two p'
  Stress stress(const double *state) const;
  void share_out(const Shear &deviator, double pressure, double *state) const;
  Stiffness tangent(std::size_t point) const;

  std::size_t extra_; // where the last part begins
  double bulk_per_shear_;
};
} // namespace isostat
