// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/error.hpp"
#include "fem/material/elastic.hpp"

#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <limits>

namespace isostat
{
/// Soil whose shear modulus depends on the shear strain gamma = 2 sqrt(J2) reached, so that answers are known in closed
/// form: s = 2 G(gamma) e. It can refuse increments, as a volume of grains may.
class SecantMaterial : public Material
{
public:
  struct Secant
  {
    double modulus, slope; // G and dG/dgamma
  };
  using Law = std::function<Secant(double gamma)>;

  SecantMaterial(double bulk_modulus, Law law, std::size_t n_points)
      : bulk_(bulk_modulus), law_(std::move(law)), committed_(n_points), trial_(n_points)
  {
    for (auto &e : committed_)
      e.fill(0);
    trial_ = committed_;
  }
  double largest_increment = std::numeric_limits<double>::infinity(); // of gamma
  double largest_strain = std::numeric_limits<double>::infinity();
  unsigned refusals = 0;

  std::string name() const override { return "secant"; }
  std::size_t n_points() const override { return committed_.size(); }
  void set_initial_stress(std::span<const Stress>) override {}
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override
  {
    for (std::size_t q = 0; q < committed_.size(); ++q)
      {
        const std::array<double, 6> de = strain(increments[q]);
        for (int c = 0; c < 6; ++c)
          trial_[q][c] = committed_[q][c] + de[c];
        if (gamma_of(de) > largest_increment || gamma_of(trial_[q]) > largest_strain)
          {
            ++refusals;
            throw RunFailure(fmt::format("point {}: shear strain increment {:.3g} is too large", q, gamma_of(de)));
          }
        stresses[q] = stress_of(trial_[q]);
      }
  }
  void commit() override { committed_ = trial_; }
  void rollback() override { trial_ = committed_; }
  void stiffness(std::span<Stiffness> tangents) const override
  {
    for (std::size_t q = 0; q < trial_.size(); ++q)
      {
        const double gamma = gamma_of(trial_[q]);
        const Secant secant = law_(gamma);
        tangents[q] = isotropic_stiffness(bulk_, secant.modulus);
        const Eigen::Matrix<double, 6, 1> e = deviator(trial_[q]);
        if (gamma > 0)
          tangents[q] += 4 * secant.slope / gamma * e * e.transpose();
      }
  }
  void wave_moduli(std::span<WaveModuli> moduli) const override
  {
    const double g = law_(0).modulus;
    std::fill(moduli.begin(), moduli.end(), WaveModuli{bulk_ + 4 * g / 3, g});
  }
  MaterialState pack() const override
  {
    return {{}, packed_rows({committed_[0].data(), 6 * committed_.size()}, committed_.size())};
  }
  void unpack(const MaterialState &state) override
  {
    unpack_rows(state, name(), {committed_[0].data(), 6 * committed_.size()}, committed_.size());
    trial_ = committed_;
  }

private:
  using Strain = std::array<double, 6>; // shear as gamma

  static Eigen::Matrix<double, 6, 1> deviator(const Strain &e)
  {
    const double mean = (e[0] + e[1] + e[2]) / 3;
    return Eigen::Matrix<double, 6, 1>{e[0] - mean, e[1] - mean, e[2] - mean, e[3] / 2, e[4] / 2, e[5] / 2};
  }
  static double gamma_of(const Strain &e)
  {
    const Eigen::Matrix<double, 6, 1> d = deviator(e);
    return std::sqrt(2 * (d.head<3>().squaredNorm() + 2 * d.tail<3>().squaredNorm()));
  }
  Stress stress_of(const Strain &e) const
  {
    const Eigen::Matrix<double, 6, 1> d = deviator(e);
    const double shear = law_(gamma_of(e)).modulus, mean = bulk_ * (e[0] + e[1] + e[2]);
    Stress s;
    for (int c = 0; c < 6; ++c)
      s[c] = 2 * shear * d[c] + (c < 3 ? mean : 0);
    return s;
  }

  double bulk_;
  Law law_;
  std::vector<Strain> committed_, trial_;
};

/// tau = G gamma/(1 + gamma G/strength): the strength is never quite reached.
inline SecantMaterial::Law hyperbola(double shear_modulus, double strength)
{
  return [=](double gamma) {
    const double x = 1 + gamma * shear_modulus / strength;
    return SecantMaterial::Secant{shear_modulus / x, -shear_modulus * shear_modulus / strength / (x * x)};
  };
}

/// tau = G (gamma + gamma^3/gamma_0^2): stiffer with strain, so that Newton's first step goes much too far.
inline SecantMaterial::Law locking(double shear_modulus, double gamma_0)
{
  return [=](double gamma) {
    return SecantMaterial::Secant{shear_modulus * (1 + gamma * gamma / (gamma_0 * gamma_0)),
                                  2 * shear_modulus * gamma / (gamma_0 * gamma_0)};
  };
}

/// G gamma to the peak, then (peak - residual) exp[-(gamma - gamma_peak)/fall] + residual.
struct Softening
{
  double modulus = 5e7, peak = 1e5, residual = 0.3e5; // Pa
  double fall = 1e-2;                                 // of strain

  double at_peak() const { return peak / modulus; }
  double stress(double gamma) const
  {
    return gamma <= at_peak() ? modulus * gamma : residual + (peak - residual) * std::exp(-(gamma - at_peak()) / fall);
  }
  SecantMaterial::Law law() const
  {
    return [*this](double gamma) {
      if (gamma <= at_peak())
        return SecantMaterial::Secant{modulus, 0};
      const double tau = stress(gamma), slope = -(tau - residual) / fall;
      return SecantMaterial::Secant{tau / gamma, (slope - tau / gamma) / gamma};
    };
  }
  /// All strengths times a factor.
  Softening times(double factor) const { return {modulus, factor * peak, factor * residual, fall}; }
};

/// A column of sand of unit height that the surface shears along x; the base is fixed.
inline MeshSpec sheared_column_mesh(unsigned cells = 4, double permeability = 1e-5)
{
  MeshSpec mesh;
  mesh.soil.layers = {{.name = "sand", .thickness = 1, .permeability = permeability}};
  mesh.soil.layers[0].cells = cells;
  return mesh;
}
inline Supports fixed_base()
{
  return {.fixed = {{Face::base, 0}, {Face::base, 1}, {Face::base, 2}}, .drained = {Face::surface}};
}
} // namespace isostat
