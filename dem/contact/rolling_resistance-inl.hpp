// SPDX-License-Identifier: BSD-3-Clause
// Laws with rolling resistance over lanes: contact_force() of rolling_resistance.cpp, as many pairs at once as there
// are lanes. Included once per instruction set (hence no #pragma once).
// tested: tests/dem/contact/loop_test.cpp
#if defined(ISOSTAT_ROLLING_RESISTANCE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOSTAT_ROLLING_RESISTANCE_INL_HPP
#undef ISOSTAT_ROLLING_RESISTANCE_INL_HPP
#else
#define ISOSTAT_ROLLING_RESISTANCE_INL_HPP
#endif

#include "dem/contact/loop-inl.hpp"
#include "dem/contact/rolling_resistance.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// Parameters and their products with the time step, so that the loop loads one number.
struct RollingResistanceNumbers
{
  double friction, rolling_limit, dt, half_dt, shear_dt, rolling_dt, twisting_dt;
  double stiffness_ratio, rolling_stiffness, twisting_stiffness;

  RollingResistanceNumbers(const RollingResistance &law, double step)
      : friction(law.friction), rolling_limit(law.rolling_limit), dt(step), half_dt(0.5 * step),
        shear_dt(law.tangential_ratio() * step), rolling_dt(shear_dt * law.rolling_stiffness),
        twisting_dt(shear_dt * law.twisting_stiffness), stiffness_ratio(law.tangential_ratio()),
        rolling_stiffness(law.rolling_stiffness), twisting_stiffness(law.twisting_stiffness)
  {}
};

/// Springs: how kn and fn follow from the overlap,
///
///     Numbers                            derived from RollingResistanceNumbers
///     Springs(numbers, pairs)            with the members kn, fn; 0 where nothing touches
///     varies                             kn depends on the overlap; then there is a member compliance, 1/kn, as well
///     shear_stiffness_before(numbers, r1 r2, reach) -> V     ks of a contact that opens, where kn does not vary
template <typename Springs, bool Friction, bool Rolling, bool Twisting>
struct RollingResistanceLanes
{
  using Numbers = typename Springs::Numbers;
  static constexpr bool is_central = !Friction, varies = Springs::varies;
  static constexpr std::size_t lanes = ContactList::lanes;
  static constexpr std::size_t n_components = Friction ? 6 + 3 * Rolling + 3 * Twisting + varies : 0;
  static constexpr std::size_t at_shear = 3, at_bending = 6, at_twisting = Rolling ? 9 : 6, at_own = n_components - 1;

  static HWY_INLINE V normal_stiffness(const Numbers &k, const Pairs &p) { return Springs(k, p).kn; }
  static HWY_INLINE V normal_force(const Numbers &k, const Pairs &p) { return Springs(k, p).fn; }

  /// ks of the step before, of a contact that opens.
  static V stiffness_before(const Numbers &k, const double *h, V rr, V reach)
  {
    if constexpr (varies)
      return hn::Div(hn::Set(D(), k.stiffness_ratio), hn::LoadU(D(), h + at_own * lanes));
    else
      return Springs::shear_stiffness_before(k, rr, reach);
  }

  /// Elastic energy that an opening contact forgets, J.
  static V forgotten(const Numbers &k, const double *h, V rr, V reach)
  {
    const V ks = stiffness_before(k, h, rr, reach);
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
    Springs springs;
    V kn, fn;
    Turning turning;
    V grown; ///< kn over that of the step before; 0 for a new contact

    HWY_INLINE Contact(const Numbers &numbers, const Pairs &pairs, const double *h)
        : k(numbers), p(pairs), springs(k, p), kn(springs.kn), fn(springs.fn), turning(p, h, k.half_dt)
    {
      if constexpr (varies)
        grown = hn::Mul(kn, hn::LoadU(D(), h + at_own * lanes));
    }

    HWY_INLINE Mask yielded(V factor) const { return hn::And(p.touching, hn::Lt(factor, hn::Set(D(), 1.0))); }

    /// History of the step before; that of a contact which has shrunk since has shrunk with it.
    HWY_INLINE Triple past(const double *h) const
    {
      const Triple z = load3(h);
      if constexpr (varies)
        return scaled(z, hn::Min(grown, hn::Set(D(), 1.0)));
      return z;
    }

    /// Elastic energy that a change of stiffness took from a spring, J: what it holds now, times max(g, 1/g) - 1.
    HWY_INLINE V lost(const Triple &now, V stiffness) const
    {
      const D d;
      if constexpr (!varies)
        return hn::Zero(d);
      const Mask known = hn::Gt(grown, hn::Zero(d));
      const V share = hn::Sub(hn::Max(grown, hn::Div(hn::Set(d, 1.0), grown)), hn::Set(d, 1.0));
      return hn::IfThenElseZero(known, hn::Mul(share, hn::Div(hn::Mul(dot(now, now), hn::Set(d, 0.5)), stiffness)));
    }

    /// v_r = alpha (v2 - v1) - (R1 w1 + R2 w2) x n;  fs <- turned(c fs) - ks dt [v_r - (v_r.n) n], |fs| <= mu fn
    template <bool Energy>
    HWY_INLINE Triple shear_force(double *h, const LoopView &sums, std::size_t pair) const
    {
      const D d;
      const Triple rolling_speed = madd(p.w1, p.r1, scaled(p.w2, p.r2));
      const V alpha = closed(p, hn::Mul(p.reach, p.inv_distance));
      const Triple vr = minus_cross(scaled(p.dv, alpha), rolling_speed, p.n);
      const Triple before = turning.turned(past(h + at_shear * lanes));
      const Triple slip_rate = nmadd(p.n, dot(vr, p.n), vr);
      const Triple trial = nmadd(slip_rate, hn::Mul(kn, hn::Set(d, k.shear_dt)), before);
      const V factor = return_factor(trial, hn::Mul(fn, hn::Set(d, k.friction)));
      const Triple fs = scaled(trial, factor);
      store3(fs, h + at_shear * lanes);
      if constexpr (Energy)
        {
          const V ks = hn::Mul(kn, hn::Set(d, k.stiffness_ratio));
          V work = plastic_work(before, trial, fs, ks, yielded(factor));
          if constexpr (varies)
            work = hn::Add(work, lost(before, ks));
          hn::StoreU(work, d, sums.sliding + pair);
          // fs.(true slip rate - slip rate of the law) dt
          const Triple mid = scaled(plus(before, fs), hn::Set(d, 0.5));
          const Triple arm_gap = scaled(cross(plus(p.w1, p.w2), p.n), hn::Mul(p.overlap, hn::Set(d, 0.5)));
          const Triple gap = nmadd(p.dv, hn::Mul(p.overlap, p.inv_distance), arm_gap);
          hn::StoreU(closed(p, hn::Mul(dot(mid, gap), hn::Set(d, k.dt))), d, sums.created + pair);
        }
      store3(p.n, h);
      if constexpr (varies)
        hn::StoreU(springs.compliance, d, h + at_own * lanes);
      return fs;
    }

    /// mb <- turned(c mb) - kr dt dw_b, |mb| <= rho_r fn;  mt <- turned(c mt) - kt dt dw_t;  returns mb + mt
    template <bool Energy>
    HWY_INLINE Triple moment(double *h, const LoopView &sums, std::size_t pair) const
    {
      const D d;
      Triple sum = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
      if constexpr (Rolling || Twisting)
        {
          const Triple dw = minus(p.w2, p.w1);
          const V spin_n = dot(dw, p.n), rr_kn = hn::Mul(hn::Mul(p.r1, p.r2), kn);
          [[maybe_unused]] V work = hn::Zero(d);
          if constexpr (Rolling)
            {
              const Triple before = turning.turned(past(h + at_bending * lanes));
              const V rate = hn::Mul(rr_kn, hn::Set(d, k.rolling_dt));
              const Triple trial = nmadd(nmadd(p.n, spin_n, dw), rate, before);
              const V factor =
                  return_factor(trial, hn::Mul(fn, hn::Mul(hn::Min(p.r1, p.r2), hn::Set(d, k.rolling_limit))));
              sum = scaled(trial, factor);
              store3(sum, h + at_bending * lanes);
              if constexpr (Energy)
                {
                  const V kr = hn::Mul(rr_kn, hn::Set(d, k.stiffness_ratio * k.rolling_stiffness));
                  work = plastic_work(before, trial, sum, kr, yielded(factor));
                  if constexpr (varies)
                    work = hn::Add(work, lost(before, kr));
                }
            }
          if constexpr (Twisting)
            {
              const Triple z = past(h + at_twisting * lanes);
              const V rate = hn::Mul(rr_kn, hn::Set(d, k.twisting_dt));
              const Triple with_tilt = turning.turned_whole(z); // mt is along n'
              if constexpr (Energy && varies)
                work = hn::Add(work,
                               lost(with_tilt, hn::Mul(rr_kn, hn::Set(d, k.stiffness_ratio * k.twisting_stiffness))));
              const V turned_by = hn::Mul(rate, spin_n);
              const Triple mt = {closed(p, hn::NegMulAdd(p.n.x, turned_by, with_tilt.x)),
                                 closed(p, hn::NegMulAdd(p.n.y, turned_by, with_tilt.y)),
                                 closed(p, hn::NegMulAdd(p.n.z, turned_by, with_tilt.z))};
              store3(mt, h + at_twisting * lanes);
              sum = Rolling ? plus(sum, mt) : mt;
            }
          if constexpr (Energy && (Rolling || varies))
            hn::StoreU(work, d, sums.rolling + pair);
        }
      return sum;
    }
  };
};

/// The loop with the parts of the law that act.
template <typename Springs>
void run_rolling_resistance(const LawFeatures &on, const LoopView &view, const typename Springs::Numbers &numbers)
{
  if (!on.friction)
    run_loop<RollingResistanceLanes<Springs, false, false, false>>(view, numbers);
  else if (on.rolling && on.twisting)
    run_loop<RollingResistanceLanes<Springs, true, true, true>>(view, numbers);
  else if (on.rolling)
    run_loop<RollingResistanceLanes<Springs, true, true, false>>(view, numbers);
  else if (on.twisting)
    run_loop<RollingResistanceLanes<Springs, true, false, true>>(view, numbers);
  else
    run_loop<RollingResistanceLanes<Springs, true, false, false>>(view, numbers);
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();
#endif
