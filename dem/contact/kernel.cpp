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
  const std::uint32_t *first, *second, *target;
  double *history, *action;
  std::uint8_t *occupied;
  std::size_t begin, end; ///< blocks
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

/// Scales `z` back to |z| <= limit; returns the mask of lanes that were outside. With a cheap root there is no branch:
/// about as many vectors have a yielding lane as have none, and a wrong guess costs more than the root.
HWY_INLINE Mask return_to(Triple &z, V limit)
{
  const V norm2 = dot(z, z);
  const Mask outside = hn::Gt(norm2, hn::Mul(limit, limit));
  if (HWY_TARGET <= HWY_AVX3 || HWY_UNLIKELY(!hn::AllFalse(D(), outside)))
    z = scaled(z, hn::IfThenElse(outside, hn::Mul(limit, inverse_root(norm2)), hn::Set(D(), 1.0)));
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

  /// Vectors of the pair that all parts of the law share.
  struct Kinematics
  {
    Triple n0, n, tilt, turn; ///< n', n, a = n' x n, a + s
    V along;                  ///< s = along n'
    V r1, r2, rr, overlap, fn, ks;
    Triple dv, w1, w2;
    Mask touching;
  };

  /// z - z x (a + s): history that is normal to n' turned with the contact; (z x a) x s = a (s.z) is 0 for it.
  static Triple turned(const Kinematics &p, const Triple &z) { return minus_cross(z, p.turn); }

  static HWY_INLINE void sub_block(const KernelView &k, std::size_t pair, double *h, bool occupied,
                                   std::uint8_t &touched)
  {
    const D d;
    const Records x1 = load_records(k.position, k.first + pair), x2 = load_records(k.position, k.second + pair);
    const Quad between = transposed(differences_and_sum(x1, x2));
    const Triple &branch = between.xyz;
    const V reach = between.w, distance2 = dot(branch, branch);
    if (HWY_UNLIKELY(hn::AllFalse(d, hn::Lt(distance2, hn::Mul(reach, reach)))))
      return skip(k, pair, h, occupied, transposed(x1).w, reach);
    touched = 1;
    const V inv_distance = inverse_root(distance2);
    Kinematics p;
    p.overlap = hn::Sub(reach, root(distance2, inv_distance));
    p.touching = hn::Gt(p.overlap, hn::Zero(d));
    // lanes that do not touch get n = 0, kn = 0 and an empty history: all they add is an exact 0
    const V inv_closed = hn::IfThenElseZero(p.touching, inv_distance);
    p.n = scaled(branch, inv_closed);
    const V stiffness = hn::Mul(inverse(reach), hn::Set(d, 2 * k.young));
    if constexpr (!Friction)
      {
        const V r1 = transposed(x1).w, rr = hn::Mul(r1, hn::Sub(reach, r1));
        const V kn = hn::IfThenElseZero(p.touching, hn::Mul(rr, stiffness));
        add_forces(k.action, k.first + pair, k.target + pair, scaled(p.n, hn::Mul(kn, p.overlap)));
        return;
      }
    else
      {
        const Quad moving = transposed(
            differences(load_records(k.velocity, k.first + pair), load_records(k.velocity, k.second + pair), x1));
        p.dv = moving.xyz;
        p.r1 = moving.w;
        p.r2 = hn::Sub(reach, p.r1);
        p.rr = hn::Mul(p.r1, p.r2);
        const V kn = hn::IfThenElseZero(p.touching, hn::Mul(p.rr, stiffness));
        p.fn = hn::Mul(kn, p.overlap);
        p.ks = hn::Mul(kn, hn::Set(d, k.stiffness_ratio));
        p.w1 = transposed(load_records(k.spin, k.first + pair)).xyz;
        p.w2 = transposed(load_records(k.spin, k.second + pair)).xyz;
        if constexpr (Energy)
          store_released(k, pair, h, p.touching, p.rr, reach);
        turn_with_contact(k, h, p);
        const Triple fs = shear(k, pair, h, p, hn::Mul(reach, inv_closed), hn::Mul(p.overlap, inv_closed));
        store3(p.n, h);

        // F at the contact point: T1 = -(R1-u/2) n x fs - M,  T2 = -(R2-u/2) n x fs + M
        const Triple moment = moments(k, pair, h, p);
        const V half = hn::Set(d, 0.5);
        const Triple force = madd(p.n, p.fn, fs), couple = cross(p.n, fs);
        add_actions(k.action, k.first + pair, k.target + pair, force,
                    nmsub(couple, hn::NegMulAdd(half, p.overlap, p.r1), moment),
                    nmadd(couple, hn::NegMulAdd(half, p.overlap, p.r2), moment));
      }
  }

  /// A vector of pairs none of which touches: history is forgotten, nothing else happens.
  static void skip(const KernelView &k, std::size_t pair, double *h, bool occupied, V r1, V reach)
  {
    if (!Friction || !occupied)
      return;
    if constexpr (Energy)
      store_released(k, pair, h, hn::Gt(hn::Zero(D()), hn::Zero(D())), hn::Mul(r1, hn::Sub(reach, r1)), reach);
    clear(h);
  }

  static void store_released(const KernelView &k, std::size_t pair, const double *h, Mask touching, V rr, V reach)
  {
    const D d;
    const Triple n0 = load3(h);
    const V ks = hn::Div(hn::Mul(rr, hn::Set(d, 2 * k.young * k.stiffness_ratio)),
                         hn::Max(reach, hn::Set(d, 1e-300)));
    const Mask opened = hn::AndNot(touching, hn::Gt(dot(n0, n0), hn::Zero(d)));
    hn::StoreU(hn::IfThenElseZero(opened, forgotten(k, h, ks, rr)), d, k.released + pair);
  }

  /// a = n' x n,  s = (dt/2) [n'.(w1 + w2)] n'
  static HWY_INLINE void turn_with_contact(const KernelView &k, const double *h, Kinematics &p)
  {
    p.n0 = load3(p.touching, h);
    p.tilt = cross(p.n0, p.n);
    p.along = hn::Mul(hn::Set(D(), 0.5 * k.dt), dot(p.n0, plus(p.w1, p.w2)));
    p.turn = madd(p.n0, p.along, p.tilt);
  }

  /// v_r = alpha (v2 - v1) - (R1 w1 + R2 w2) x n;  fs <- turned(fs) - ks dt [v_r - (v_r.n) n], |fs| <= mu fn
  static HWY_INLINE Triple shear(const KernelView &k, std::size_t pair, double *h, const Kinematics &p, V alpha,
                                 V relative_overlap)
  {
    const D d;
    const V dt = hn::Set(d, k.dt);
    const Triple rolling_speed = madd(p.w1, p.r1, scaled(p.w2, p.r2));
    const Triple vr = minus_cross(scaled(p.dv, alpha), rolling_speed, p.n);
    const Triple before = turned(p, load3(p.touching, h + at_shear * lanes));
    const Triple trial = nmadd(nmadd(p.n, dot(vr, p.n), vr), hn::Mul(p.ks, dt), before);
    Triple fs = trial;
    const Mask sliding = return_to(fs, hn::Mul(p.fn, hn::Set(d, k.friction)));
    store3(fs, h + at_shear * lanes);
    if constexpr (Energy)
      {
        hn::StoreU(plastic_work(before, trial, fs, p.ks, hn::And(p.touching, sliding)), d, k.sliding + pair);
        // fs.(true slip rate - slip rate of the law) dt
        const Triple mid = scaled(plus(before, fs), hn::Set(d, 0.5));
        const Triple arm_gap = scaled(cross(plus(p.w1, p.w2), p.n), hn::Mul(p.overlap, hn::Set(d, 0.5)));
        const Triple gap = nmadd(p.dv, relative_overlap, arm_gap);
        hn::StoreU(hn::IfThenElseZero(p.touching, hn::Mul(dot(mid, gap), dt)), d, k.created + pair);
      }
    return fs;
  }

  /// mb <- turned(mb) - kr dt dw_b, |mb| <= rho_r fn;  mt <- turned(mt) - kt dt dw_t;  returns mb + mt
  static HWY_INLINE Triple moments(const KernelView &k, std::size_t pair, double *h, const Kinematics &p)
  {
    const D d;
    Triple moment = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if constexpr (Rolling || Twisting)
      {
        const Triple dw = minus(p.w2, p.w1);
        const V spin_n = dot(dw, p.n), rr_ks = hn::Mul(p.rr, p.ks);
        if constexpr (Rolling)
          {
            const Triple before = turned(p, load3(p.touching, h + at_bending * lanes));
            const V rate = hn::Mul(rr_ks, hn::Set(d, k.rolling_stiffness * k.dt));
            const Triple trial = nmadd(nmadd(p.n, spin_n, dw), rate, before);
            moment = trial;
            const Mask rolls =
                return_to(moment, hn::Mul(p.fn, hn::Mul(hn::Min(p.r1, p.r2), hn::Set(d, k.rolling_limit))));
            store3(moment, h + at_bending * lanes);
            if constexpr (Energy)
              {
                const V kr = hn::Mul(rr_ks, hn::Set(d, k.rolling_stiffness));
                hn::StoreU(plastic_work(before, trial, moment, kr, hn::And(p.touching, rolls)), d, k.rolling + pair);
              }
          }
        if constexpr (Twisting)
          {
            const Triple z = load3(p.touching, h + at_twisting * lanes);
            const V rate = hn::Mul(rr_ks, hn::Set(d, k.twisting_stiffness * k.dt));
            const Triple with_tilt = madd(p.tilt, hn::Mul(p.along, dot(p.n0, z)), turned(p, z)); // mt is along n'
            const Triple mt = nmadd(p.n, hn::Mul(rate, spin_n), with_tilt);
            store3(mt, h + at_twisting * lanes);
            moment = Rolling ? plus(moment, mt) : mt;
          }
      }
    return moment;
  }

  static void run(const KernelView &k)
  {
    for (std::size_t b = k.begin; b < k.end; ++b)
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
                  list.second(),
                  list.history_data(),
                  action,
                  list.occupied(),
                  0,
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
