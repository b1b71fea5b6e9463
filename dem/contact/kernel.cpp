// SPDX-License-Identifier: BSD-3-Clause
// The contact loop, compiled once per instruction set and chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/contact/kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dem/contact/kernel.hpp"
#include "dem/contact/records-inl.hpp"

#ifndef ISOSTAT_KERNEL_ARGS
#define ISOSTAT_KERNEL_ARGS
namespace isostat
{
/// Plain view of everything the loop touches.
struct KernelView
{
  const double *position, *velocity, *spin;
  const std::uint32_t *first, *second;
  double *history, *action;
  std::uint8_t *occupied;
  std::size_t n_blocks;
  double young, stiffness_ratio, friction, rolling_stiffness, rolling_limit, twisting_stiffness, dt;
  double *sliding, *rolling, *released, *created;
};
} // namespace isostat
#endif

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// z1 = z - z x a ; z2 = z1 - z1 x s
HWY_INLINE Triple rotated(const Triple &z, const Triple &a, const Triple &s)
{
  return minus_cross(minus_cross(z, a), s);
}

/// Scales `z` back to |z| <= limit; returns the mask of lanes that were outside.
HWY_INLINE Mask return_to(Triple &z, V limit)
{
  const V norm2 = dot(z, z);
  const Mask outside = hn::Gt(norm2, hn::Mul(limit, limit));
  if (HWY_UNLIKELY(!hn::AllFalse(D(), outside)))
    {
      const V scale = hn::IfThenElse(outside, hn::Mul(limit, inverse_root(norm2)), hn::Set(D(), 1.0));
      z = scaled(z, scale);
    }
  return outside;
}

/// Work that a return to the yield surface dissipates, (mid-step force).(trial - returned)/stiffness, J.
HWY_INLINE V plastic_work(const Triple &before, const Triple &trial, const Triple &after, V stiffness, Mask yielded)
{
  const V half = hn::Set(D(), 0.5);
  const Triple mid = scaled(plus(before, after), half);
  return hn::IfThenElseZero(yielded, hn::Div(dot(mid, minus(trial, after)), stiffness));
}

template <bool Friction, bool Rolling, bool Twisting, bool Energy>
struct Loop
{
  static constexpr std::size_t n_components = Friction ? 6 + 3 * Rolling + 3 * Twisting : 0;
  static constexpr std::size_t lanes = ContactList::lanes;
  static constexpr std::size_t at_shear = 3, at_bending = 6, at_twisting = Rolling ? 9 : 6;

  static void clear(double *history)
  {
    for (std::size_t c = 0; c < n_components; ++c)
      hn::Store(hn::Zero(D()), D(), history + c * lanes);
  }

  /// Elastic energy that an opening contact forgets, J.
  static V forgotten(const KernelView &k, const double *h, V ks, V rr)
  {
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

  static void sub_block(const KernelView &k, std::size_t pair, double *h, bool occupied, std::uint8_t &touched)
  {
    const D d;
    const V zero = hn::Zero(d), dt = hn::Set(d, k.dt);
    const Quad p1 = load_records(k.position, k.first + pair), p2 = load_records(k.position, k.second + pair);
    const Triple branch = minus(p2.xyz, p1.xyz);
    const V r1 = p1.w, r2 = p2.w;
    const V distance2 = dot(branch, branch), reach = hn::Add(r1, r2);
    if (hn::AllFalse(d, hn::Lt(distance2, hn::Mul(reach, reach))))
      {
        if (Friction && occupied)
          {
            if constexpr (Energy)
              {
                const V rr = hn::Mul(r1, r2);
                const V ks = hn::Div(hn::Mul(rr, hn::Set(d, 2 * k.young * k.stiffness_ratio)),
                                     hn::Max(reach, hn::Set(d, 1e-300)));
                const Triple n0 = load3(h);
                hn::StoreU(hn::IfThenElseZero(hn::Gt(dot(n0, n0), zero), forgotten(k, h, ks, rr)), d,
                           k.released + pair);
              }
            clear(h);
          }
        return;
      }
    touched = 1;
    const V inv_distance = inverse_root(distance2), distance = root(distance2, inv_distance);
    const V inv_reach = inverse(hn::Max(reach, hn::Set(d, 1e-300)));
    const V overlap = hn::Sub(reach, distance);
    const Mask touching = hn::Gt(overlap, zero);
    const Triple n = scaled(branch, inv_distance);
    const V rr = hn::Mul(r1, r2);
    const V kn = hn::Mul(hn::Mul(rr, inv_reach), hn::Set(d, 2 * k.young));
    const V fn = hn::IfThenElseZero(touching, hn::Mul(kn, overlap));
    if constexpr (!Friction)
      {
        add_forces(k.action, k.first + pair, k.second + pair, scaled(n, fn));
        return;
      }
    else
      {
        const V ks = hn::Mul(kn, hn::Set(d, k.stiffness_ratio));
        const Triple n0 = load3(h);
        if constexpr (Energy)
          {
            const Mask opened = hn::AndNot(touching, hn::Gt(dot(n0, n0), zero));
            hn::StoreU(hn::IfThenElseZero(opened, forgotten(k, h, ks, rr)), d, k.released + pair);
          }
        const Triple v1 = load_records(k.velocity, k.first + pair).xyz,
                     v2 = load_records(k.velocity, k.second + pair).xyz;
        const Triple w1 = load_records(k.spin, k.first + pair).xyz, w2 = load_records(k.spin, k.second + pair).xyz;

        const Triple tilt = cross(n0, n);
        const Triple w_sum = plus(w1, w2);
        const Triple twist = scaled(n0, hn::Mul(hn::Mul(hn::Set(d, 0.5), dt), dot(n0, w_sum)));

        // v_r = alpha (v2 - v1) - (R1 w1 + R2 w2) x n,  alpha = (R1+R2)/|b|
        const Triple rolling_speed = madd(w1, r1, scaled(w2, r2));
        const Triple vr = minus_cross(scaled(minus(v2, v1), hn::Mul(reach, inv_distance)), rolling_speed, n);
        const Triple du = scaled(nmadd(n, dot(vr, n), vr), dt);

        const Triple fs_before = rotated(load3(h + at_shear * lanes), tilt, twist);
        const Triple fs_trial = nmadd(du, ks, fs_before);
        Triple fs = fs_trial;
        const Mask sliding = return_to(fs, hn::Mul(fn, hn::Set(d, k.friction)));
        if constexpr (Energy)
          {
            hn::StoreU(hn::IfThenElseZero(touching, plastic_work(fs_before, fs_trial, fs, ks, sliding)), d,
                       k.sliding + pair);
            // fs.(true slip rate - slip rate of the law) dt
            const Triple mid = scaled(plus(fs_before, fs), hn::Set(d, 0.5));
            const Triple arm_gap = scaled(cross(w_sum, n), hn::Mul(overlap, hn::Set(d, 0.5)));
            const Triple gap = nmadd(minus(v2, v1), hn::Mul(overlap, inv_distance), arm_gap);
            hn::StoreU(hn::IfThenElseZero(touching, hn::Mul(dot(mid, gap), dt)), d, k.created + pair);
          }
        fs = masked(touching, fs);
        store3(fs, h + at_shear * lanes);
        store3(masked(touching, n), h);

        // moments: split of the relative spin along n
        const Triple dw = minus(w2, w1);
        const V spin_n = dot(dw, n);
        Triple moment = {zero, zero, zero};
        if constexpr (Rolling)
          {
            const V kr = hn::Mul(hn::Mul(rr, ks), hn::Set(d, k.rolling_stiffness));
            const Triple before = rotated(load3(h + at_bending * lanes), tilt, twist);
            const Triple trial = nmadd(nmadd(n, spin_n, dw), hn::Mul(kr, dt), before);
            Triple mb = trial;
            const V limit = hn::Mul(fn, hn::Mul(hn::Min(r1, r2), hn::Set(d, k.rolling_limit)));
            const Mask rolls = return_to(mb, limit);
            if constexpr (Energy)
              hn::StoreU(hn::IfThenElseZero(touching, plastic_work(before, trial, mb, kr, rolls)), d, k.rolling + pair);
            mb = masked(touching, mb);
            store3(mb, h + at_bending * lanes);
            moment = mb;
          }
        if constexpr (Twisting)
          {
            const V kt = hn::Mul(hn::Mul(rr, ks), hn::Set(d, k.twisting_stiffness));
            Triple mt = rotated(load3(h + at_twisting * lanes), tilt, twist);
            mt = masked(touching, nmadd(n, hn::Mul(hn::Mul(kt, dt), spin_n), mt));
            store3(mt, h + at_twisting * lanes);
            moment = Rolling ? plus(moment, mt) : mt;
          }

        // F at the contact point: T1 = -(R1-u/2) n x fs - M,  T2 = -(R2-u/2) n x fs + M
        const V half_overlap = hn::Mul(overlap, hn::Set(d, 0.5));
        const Triple force = madd(n, fn, fs);
        const Triple couple = cross(n, fs);
        const Triple torque1 = negated(madd(couple, hn::Sub(r1, half_overlap), moment));
        const Triple torque2 = nmadd(couple, hn::Sub(r2, half_overlap), moment);
        add_actions(k.action, k.first + pair, k.second + pair, force, torque1, torque2);
      }
  }

  static void run(const KernelView &k)
  {
    for (std::size_t b = 0; b < k.n_blocks; ++b)
      {
        std::uint8_t touched = 0;
        for (std::size_t l = 0; l < lanes; l += hn::Lanes(D()))
          sub_block(k, b * lanes + l, k.history + b * n_components * lanes + l, k.occupied[b], touched);
        k.occupied[b] = touched;
      }
  }
};

// Each variant is exported under its own name: run-time dispatch works on plain functions.
#define ISOSTAT_VARIANT(NAME, F, R, T, E) \
  void NAME(const KernelView &k) { Loop<F, R, T, E>::run(k); }
ISOSTAT_VARIANT(Frictionless, false, false, false, false)
ISOSTAT_VARIANT(Sliding, true, false, false, false)
ISOSTAT_VARIANT(Rolling, true, true, false, false)
ISOSTAT_VARIANT(Twisting, true, false, true, false)
ISOSTAT_VARIANT(Full, true, true, true, false)
ISOSTAT_VARIANT(SlidingEnergy, true, false, false, true)
ISOSTAT_VARIANT(RollingEnergy, true, true, false, true)
ISOSTAT_VARIANT(TwistingEnergy, true, false, true, true)
ISOSTAT_VARIANT(FullEnergy, true, true, true, true)
#undef ISOSTAT_VARIANT

const char *InstructionSet() { return hwy::TargetName(HWY_TARGET); }
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
HWY_EXPORT(Frictionless);
HWY_EXPORT(Sliding);
HWY_EXPORT(Rolling);
HWY_EXPORT(Twisting);
HWY_EXPORT(Full);
HWY_EXPORT(SlidingEnergy);
HWY_EXPORT(RollingEnergy);
HWY_EXPORT(TwistingEnergy);
HWY_EXPORT(FullEnergy);
HWY_EXPORT(InstructionSet);

namespace
{
void run_with_energy(LawFeatures on, const KernelView &view)
{
  if (on.rolling && on.twisting)
    HWY_DYNAMIC_DISPATCH(FullEnergy)(view);
  else if (on.rolling)
    HWY_DYNAMIC_DISPATCH(RollingEnergy)(view);
  else if (on.twisting)
    HWY_DYNAMIC_DISPATCH(TwistingEnergy)(view);
  else if (on.friction)
    HWY_DYNAMIC_DISPATCH(SlidingEnergy)(view);
  else
    HWY_DYNAMIC_DISPATCH(Frictionless)(view);
}

void run(LawFeatures on, const KernelView &view)
{
  if (on.rolling && on.twisting)
    HWY_DYNAMIC_DISPATCH(Full)(view);
  else if (on.rolling)
    HWY_DYNAMIC_DISPATCH(Rolling)(view);
  else if (on.twisting)
    HWY_DYNAMIC_DISPATCH(Twisting)(view);
  else if (on.friction)
    HWY_DYNAMIC_DISPATCH(Sliding)(view);
  else
    HWY_DYNAMIC_DISPATCH(Frictionless)(view);
}
} // namespace

void add_contact_forces(const LawParams &law, const Packing &packing, double dt, ContactList &list, double *action,
                        DissipationPerPair *dissipation)
{
  KernelView view{packing.position.data(),
                  packing.velocity.data(),
                  packing.spin.data(),
                  list.first(),
                  list.second(),
                  list.history_data(),
                  action,
                  list.occupied(),
                  list.n_blocks(),
                  law.young,
                  law.stiffness_ratio,
                  law.friction,
                  law.rolling_stiffness,
                  law.rolling_limit,
                  law.twisting_stiffness,
                  dt,
                  nullptr,
                  nullptr,
                  nullptr,
                  nullptr};
  if (!dissipation)
    return run(list.features(), view);
  dissipation->resize(list.n_blocks() * ContactList::lanes);
  view.sliding = dissipation->sliding.data();
  view.rolling = dissipation->rolling.data();
  view.released = dissipation->released.data();
  view.created = dissipation->created.data();
  run_with_energy(list.features(), view);
}

std::string instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }
} // namespace isostat
#endif
