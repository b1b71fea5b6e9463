// SPDX-License-Identifier: BSD-3-Clause
// The law over lanes: contact_force() of law.cpp, as many pairs at once as there are lanes. Included once per
// instruction set (hence no #pragma once).
// tested: tests/dem/contact/loop_test.cpp
#if defined(ISOSTAT_LINEAR_ROLLING_LANES_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOSTAT_LINEAR_ROLLING_LANES_INL_HPP
#undef ISOSTAT_LINEAR_ROLLING_LANES_INL_HPP
#else
#define ISOSTAT_LINEAR_ROLLING_LANES_INL_HPP
#endif

#include "dem/contact/linear_rolling/law.hpp"
#include "dem/contact/loop-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// Parameters and their products with the time step, so that the loop loads one number.
struct LinearRollingNumbers
{
  double friction, rolling_limit, dt, twice_young, half_dt, shear_dt, rolling_dt, twisting_dt;
  double stiffness_ratio, rolling_stiffness, twisting_stiffness;

  LinearRollingNumbers(const LinearRolling &law, double step)
      : friction(law.friction), rolling_limit(law.rolling_limit), dt(step), twice_young(2 * law.young),
        half_dt(0.5 * step), shear_dt(law.stiffness_ratio * step), rolling_dt(shear_dt * law.rolling_stiffness),
        twisting_dt(shear_dt * law.twisting_stiffness), stiffness_ratio(law.stiffness_ratio),
        rolling_stiffness(law.rolling_stiffness), twisting_stiffness(law.twisting_stiffness)
  {}
};

template <bool Friction, bool Rolling, bool Twisting>
struct LinearRollingLanes
{
  using Numbers = LinearRollingNumbers;
  static constexpr bool is_central = !Friction;
  static constexpr std::size_t lanes = ContactList::lanes;
  static constexpr std::size_t n_components = Friction ? 6 + 3 * Rolling + 3 * Twisting : 0;
  static constexpr std::size_t at_shear = 3, at_bending = 6, at_twisting = Rolling ? 9 : 6;

  /// kn = 2 E R1 R2/(R1+R2)
  static HWY_INLINE V normal_stiffness(const Numbers &k, const Pairs &p)
  {
    return closed(p, hn::Mul(hn::Mul(p.r1, p.r2), hn::Mul(inverse(p.reach), hn::Set(D(), k.twice_young))));
  }

  static HWY_INLINE V normal_force(const Numbers &k, const Pairs &p)
  {
    return hn::Mul(normal_stiffness(k, p), p.overlap);
  }

  /// Elastic energy that an opening contact forgets, J.
  static V forgotten(const Numbers &k, const double *h, V rr, V reach)
  {
    const D d;
    const V ks =
        hn::Div(hn::Mul(rr, hn::Set(d, k.twice_young * k.stiffness_ratio)), hn::Max(reach, hn::Set(d, 1e-300)));
    const Triple fs = load3(h + at_shear * lanes);
    V energy = hn::Div(dot(fs, fs), ks);
    if constexpr (Rolling)
      {
        const Triple mb = load3(h + at_bending * lanes);
        energy = hn::Add(energy, hn::Div(dot(mb, mb), hn::Mul(hn::Mul(rr, ks), hn::Set(D(), k.rolling_stiffness))));
      }
    if constexpr (Twisting)
      {
        const Triple mt = load3(h + at_twisting * lanes);
        energy = hn::Add(energy, hn::Div(dot(mt, mt), hn::Mul(hn::Mul(rr, ks), hn::Set(D(), k.twisting_stiffness))));
      }
    return hn::Mul(energy, hn::Set(D(), 0.5));
  }

  struct Contact
  {
    const Numbers &k;
    const Pairs &p;
    V kn, fn;
    Turning turning;

    HWY_INLINE Contact(const Numbers &numbers, const Pairs &pairs, const double *h)
        : k(numbers), p(pairs), kn(normal_stiffness(k, p)), fn(hn::Mul(kn, p.overlap)), turning(p, h, k.half_dt)
    {}

    HWY_INLINE Mask yielded(V factor) const { return hn::And(p.touching, hn::Lt(factor, hn::Set(D(), 1.0))); }

    /// v_r = alpha (v2 - v1) - (R1 w1 + R2 w2) x n;  fs <- turned(fs) - ks dt [v_r - (v_r.n) n], |fs| <= mu fn
    template <bool Energy>
    HWY_INLINE Triple shear_force(double *h, const LoopView &sums, std::size_t pair) const
    {
      const D d;
      const Triple rolling_speed = madd(p.w1, p.r1, scaled(p.w2, p.r2));
      const V alpha = closed(p, hn::Mul(p.reach, p.inv_distance));
      const Triple vr = minus_cross(scaled(p.dv, alpha), rolling_speed, p.n);
      const Triple before = turning.turned(load3(h + at_shear * lanes));
      const Triple slip_rate = nmadd(p.n, dot(vr, p.n), vr);
      const Triple trial = nmadd(slip_rate, hn::Mul(kn, hn::Set(d, k.shear_dt)), before);
      const V factor = return_factor(trial, hn::Mul(fn, hn::Set(d, k.friction)));
      const Triple fs = scaled(trial, factor);
      store3(fs, h + at_shear * lanes);
      if constexpr (Energy)
        {
          const V ks = hn::Mul(kn, hn::Set(d, k.stiffness_ratio));
          hn::StoreU(plastic_work(before, trial, fs, ks, yielded(factor)), d, sums.sliding + pair);
          // fs.(true slip rate - slip rate of the law) dt
          const Triple mid = scaled(plus(before, fs), hn::Set(d, 0.5));
          const Triple arm_gap = scaled(cross(plus(p.w1, p.w2), p.n), hn::Mul(p.overlap, hn::Set(d, 0.5)));
          const Triple gap = nmadd(p.dv, hn::Mul(p.overlap, p.inv_distance), arm_gap);
          hn::StoreU(closed(p, hn::Mul(dot(mid, gap), hn::Set(d, k.dt))), d, sums.created + pair);
        }
      store3(p.n, h);
      return fs;
    }

    /// mb <- turned(mb) - kr dt dw_b, |mb| <= rho_r fn;  mt <- turned(mt) - kt dt dw_t;  returns mb + mt
    template <bool Energy>
    HWY_INLINE Triple moment(double *h, const LoopView &sums, std::size_t pair) const
    {
      const D d;
      Triple sum = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
      if constexpr (Rolling || Twisting)
        {
          const Triple dw = minus(p.w2, p.w1);
          const V spin_n = dot(dw, p.n), rr_kn = hn::Mul(hn::Mul(p.r1, p.r2), kn);
          if constexpr (Rolling)
            {
              const Triple before = turning.turned(load3(h + at_bending * lanes));
              const V rate = hn::Mul(rr_kn, hn::Set(d, k.rolling_dt));
              const Triple trial = nmadd(nmadd(p.n, spin_n, dw), rate, before);
              const V factor =
                  return_factor(trial, hn::Mul(fn, hn::Mul(hn::Min(p.r1, p.r2), hn::Set(d, k.rolling_limit))));
              sum = scaled(trial, factor);
              store3(sum, h + at_bending * lanes);
              if constexpr (Energy)
                {
                  const V kr = hn::Mul(rr_kn, hn::Set(d, k.stiffness_ratio * k.rolling_stiffness));
                  hn::StoreU(plastic_work(before, trial, sum, kr, yielded(factor)), d, sums.rolling + pair);
                }
            }
          if constexpr (Twisting)
            {
              const Triple z = load3(h + at_twisting * lanes);
              const V rate = hn::Mul(rr_kn, hn::Set(d, k.twisting_dt));
              const Triple with_tilt = turning.turned_whole(z); // mt is along n'
              const V turned_by = hn::Mul(rate, spin_n);
              const Triple mt = {closed(p, hn::NegMulAdd(p.n.x, turned_by, with_tilt.x)),
                                 closed(p, hn::NegMulAdd(p.n.y, turned_by, with_tilt.y)),
                                 closed(p, hn::NegMulAdd(p.n.z, turned_by, with_tilt.z))};
              store3(mt, h + at_twisting * lanes);
              sum = Rolling ? plus(sum, mt) : mt;
            }
        }
      return sum;
    }
  };
};
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();
#endif
