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
  double friction, rolling_limit, dt;
  double twice_young, half_dt, shear_dt, rolling_dt, twisting_dt; ///< products, so that the loop loads one number
  double stiffness_ratio, rolling_stiffness, twisting_stiffness;
  double *sliding = nullptr, *rolling = nullptr, *released = nullptr, *created = nullptr;
  // periodic cell only
  const std::uint32_t *image = nullptr;
  const double *offsets = nullptr;
  double rate[6] = {}; ///< D: xx yy zz yz xz xy, 1/s
  double *virial = nullptr, virial_start = 0;
};
} // namespace isostat
#endif

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// min(1, limit/|z|): brings `z` back to |z| <= limit. 1 where z is 0. With a cheap root there is no branch: about as
/// many vectors have a yielding lane as have none, and a wrong guess costs more than the root.
HWY_INLINE V return_factor(const Triple &z, V limit)
{
  const D d;
  const V one = hn::Set(d, 1.0), norm2 = dot(z, z);
#if HWY_TARGET <= HWY_AVX3
  // not a number where z is 0; the minimum is then its second operand
  return V{_mm512_min_pd(hn::Mul(limit, inverse_root(norm2)).raw, one.raw)};
#else
  const Mask outside = hn::Gt(norm2, hn::Mul(limit, limit));
  if (HWY_LIKELY(hn::AllFalse(d, outside)))
    return one;
  return hn::IfThenElse(outside, hn::Mul(limit, inverse_root(norm2)), one);
#endif
}

/// Work that a return to the yield surface dissipates, (mid-step force).(trial - returned)/stiffness, J.
HWY_INLINE V plastic_work(const Triple &before, const Triple &trial, const Triple &after, V stiffness, Mask yielded)
{
  const V half = hn::Set(D(), 0.5);
  const Triple mid = scaled(plus(before, after), half);
  return hn::IfThenElseZero(yielded, hn::Div(dot(mid, minus(trial, after)), stiffness));
}

template <bool Friction, bool Rolling, bool Twisting, bool Energy, bool Periodic>
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

  /// Vectors of a pair that the parts of the law share.
  struct Kinematics
  {
    Triple n0, n, tilt, turn; ///< n', n, a = n' x n, a + s
    V along;                  ///< s = along n'
    V r1, r2, reach, inv_distance, overlap, kn, fn;
    Triple dv, w1, w2;
    Mask touching;
  };

  /// z - z x (a + s): history that is normal to n' turned with the contact; (z x a) x s = a (s.z) is 0 for it.
  static HWY_INLINE Triple turned(const Kinematics &p, const Triple &z) { return minus_cross(z, p.turn); }

  static HWY_INLINE V closed(const Kinematics &p, V v) { return hn::IfThenElseZero(p.touching, v); }

  /// dv + D b: what homogeneous strain adds to the relative velocity of the fluctuations.
  static HWY_INLINE Triple with_strain(const KernelView &k, const Triple &dv, const Triple &b)
  {
    const D d;
    auto rate = [&](int c) { return hn::Set(d, k.rate[c]); };
    return {hn::MulAdd(rate(0), b.x, hn::MulAdd(rate(5), b.y, hn::MulAdd(rate(4), b.z, dv.x))),
            hn::MulAdd(rate(5), b.x, hn::MulAdd(rate(1), b.y, hn::MulAdd(rate(3), b.z, dv.y))),
            hn::MulAdd(rate(4), b.x, hn::MulAdd(rate(3), b.y, hn::MulAdd(rate(2), b.z, dv.z)))};
  }

  /// Sums of F b and its transpose, lane by lane: see Virial.
  static HWY_INLINE void add_virial(const KernelView &k, std::size_t lane, const Triple &force, const Triple &b)
  {
    const D d;
    double *sums = k.virial + lane;
    auto add = [&](int c, V f, V l) {
      const V sum = hn::Load(d, sums + 8 * c);
#if HWY_NATIVE_FMA
      hn::Store(hn::MulAdd(f, l, sum), d, sums + 8 * c);
#else // a rounded product may be halfway between two points of the grid; which one it goes to must not follow the sum
      const V start = hn::Set(d, k.virial_start), rounded = hn::Sub(hn::MulAdd(f, l, start), start);
      hn::Store(hn::Add(sum, rounded), d, sums + 8 * c);
#endif
    };
    add(0, force.x, b.x);
    add(1, force.y, b.y);
    add(2, force.z, b.z);
    add(3, force.y, b.z), add(3, force.z, b.y);
    add(4, force.x, b.z), add(4, force.z, b.x);
    add(5, force.x, b.y), add(5, force.y, b.x);
  }

  static HWY_INLINE void sub_block(const KernelView &k, std::size_t pair, std::size_t lane, double *h, bool occupied,
                                   std::uint8_t &touched)
  {
    const D d;
    Kinematics p;
    const Records x1 = load_records(k.position, k.first + pair), x2 = load_records(k.position, k.second + pair);
    Records apart = differences_and_sum(x1, x2);
    if constexpr (Periodic)
      apart = sums(apart, load_records(k.offsets, k.image + pair));
    const Quad between = transposed(apart);
    const Triple &branch = between.xyz;
    p.reach = between.w;
    const V distance2 = dot(branch, branch);
    p.inv_distance = inverse_root(distance2);
    p.overlap = hn::Sub(p.reach, root(distance2, p.inv_distance));
    p.touching = hn::Gt(p.overlap, hn::Zero(d));
    if (HWY_UNLIKELY(hn::AllFalse(d, p.touching)))
      return skip(k, pair, h, occupied, transposed(x1).w, p.reach);
    touched = 1;
    // lanes that do not touch get n = 0, kn = 0 and an empty history: all they add is an exact 0
    p.n = {closed(p, hn::Mul(branch.x, p.inv_distance)), closed(p, hn::Mul(branch.y, p.inv_distance)),
           closed(p, hn::Mul(branch.z, p.inv_distance))};
    const V stiffness = hn::Mul(inverse(p.reach), hn::Set(d, k.twice_young));
    if constexpr (!Friction)
      {
        const V r1 = transposed(x1).w, rr = hn::Mul(r1, hn::Sub(p.reach, r1));
        const V kn = closed(p, hn::Mul(rr, stiffness));
        const Triple force = scaled(p.n, hn::Mul(kn, p.overlap));
        if constexpr (Periodic)
          add_virial(k, lane, force, branch);
        add_forces(k.action, k.first + pair, k.target + pair, force);
        return;
      }
    else
      {
        const Quad moving = transposed(
            differences(load_records(k.velocity, k.first + pair), load_records(k.velocity, k.second + pair), x1));
        p.dv = moving.xyz;
        if constexpr (Periodic)
          p.dv = with_strain(k, p.dv, branch);
        p.r1 = moving.w;
        p.w1 = transposed(load_records(k.spin, k.first + pair)).xyz;
        p.w2 = transposed(load_records(k.spin, k.second + pair)).xyz;
        p.r2 = hn::Sub(p.reach, p.r1);
        p.kn = closed(p, hn::Mul(hn::Mul(p.r1, p.r2), stiffness));
        p.fn = hn::Mul(p.kn, p.overlap);
        if constexpr (Energy)
          store_released(k, pair, h, p.touching, hn::Mul(p.r1, p.r2), p.reach);
        turn_with_contact(k, h, p);
        const Triple fs = shear(k, pair, h, p);
        store3(p.n, h);

        // F at the contact point: T1 = -(R1-u/2) n x fs - M,  T2 = -(R2-u/2) n x fs + M
        const Triple moment = moments(k, pair, h, p);
        const V half = hn::Set(d, 0.5);
        const Triple force = madd(p.n, p.fn, fs), couple = cross(p.n, fs);
        if constexpr (Periodic)
          add_virial(k, lane, force, branch);
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
    const V ks =
        hn::Div(hn::Mul(rr, hn::Set(d, k.twice_young * k.stiffness_ratio)), hn::Max(reach, hn::Set(d, 1e-300)));
    const Mask opened = hn::AndNot(touching, hn::Gt(dot(n0, n0), hn::Zero(d)));
    hn::StoreU(hn::IfThenElseZero(opened, forgotten(k, h, ks, rr)), d, k.released + pair);
  }

  /// a = n' x n,  s = (dt/2) [n'.(w1 + w2)] n'
  static HWY_INLINE void turn_with_contact(const KernelView &k, const double *h, Kinematics &p)
  {
    p.n0 = load3(h);
    p.tilt = cross(p.n0, p.n);
    p.along = hn::Mul(hn::Set(D(), k.half_dt), dot(p.n0, plus(p.w1, p.w2)));
    p.turn = madd(p.n0, p.along, p.tilt);
  }

  /// v_r = alpha (v2 - v1) - (R1 w1 + R2 w2) x n;  fs <- turned(fs) - ks dt [v_r - (v_r.n) n], |fs| <= mu fn
  static HWY_INLINE Triple shear(const KernelView &k, std::size_t pair, double *h, const Kinematics &p)
  {
    const D d;
    const Triple rolling_speed = madd(p.w1, p.r1, scaled(p.w2, p.r2));
    const V alpha = closed(p, hn::Mul(p.reach, p.inv_distance));
    const Triple vr = minus_cross(scaled(p.dv, alpha), rolling_speed, p.n);
    const Triple before = turned(p, load3(h + at_shear * lanes));
    const Triple slip_rate = nmadd(p.n, dot(vr, p.n), vr);
    const Triple trial = nmadd(slip_rate, hn::Mul(p.kn, hn::Set(d, k.shear_dt)), before);
    const V factor = return_factor(trial, hn::Mul(p.fn, hn::Set(d, k.friction)));
    const Triple fs = scaled(trial, factor);
    store3(fs, h + at_shear * lanes);
    if constexpr (Energy)
      {
        const V ks = hn::Mul(p.kn, hn::Set(d, k.stiffness_ratio));
        hn::StoreU(plastic_work(before, trial, fs, ks, yielded(p, factor)), d, k.sliding + pair);
        // fs.(true slip rate - slip rate of the law) dt
        const Triple mid = scaled(plus(before, fs), hn::Set(d, 0.5));
        const Triple arm_gap = scaled(cross(plus(p.w1, p.w2), p.n), hn::Mul(p.overlap, hn::Set(d, 0.5)));
        const Triple gap = nmadd(p.dv, hn::Mul(p.overlap, p.inv_distance), arm_gap);
        hn::StoreU(closed(p, hn::Mul(dot(mid, gap), hn::Set(d, k.dt))), d, k.created + pair);
      }
    return fs;
  }

  static Mask yielded(const Kinematics &p, V factor) { return hn::And(p.touching, hn::Lt(factor, hn::Set(D(), 1.0))); }

  /// mb <- turned(mb) - kr dt dw_b, |mb| <= rho_r fn;  mt <- turned(mt) - kt dt dw_t;  returns mb + mt
  static HWY_INLINE Triple moments(const KernelView &k, std::size_t pair, double *h, const Kinematics &p)
  {
    const D d;
    Triple moment = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if constexpr (Rolling || Twisting)
      {
        const Triple dw = minus(p.w2, p.w1);
        const V spin_n = dot(dw, p.n), rr_kn = hn::Mul(hn::Mul(p.r1, p.r2), p.kn);
        if constexpr (Rolling)
          {
            const Triple before = turned(p, load3(h + at_bending * lanes));
            const V rate = hn::Mul(rr_kn, hn::Set(d, k.rolling_dt));
            const Triple trial = nmadd(nmadd(p.n, spin_n, dw), rate, before);
            const V factor =
                return_factor(trial, hn::Mul(p.fn, hn::Mul(hn::Min(p.r1, p.r2), hn::Set(d, k.rolling_limit))));
            moment = scaled(trial, factor);
            store3(moment, h + at_bending * lanes);
            if constexpr (Energy)
              {
                const V kr = hn::Mul(rr_kn, hn::Set(d, k.stiffness_ratio * k.rolling_stiffness));
                hn::StoreU(plastic_work(before, trial, moment, kr, yielded(p, factor)), d, k.rolling + pair);
              }
          }
        if constexpr (Twisting)
          {
            const Triple z = load3(h + at_twisting * lanes);
            const V rate = hn::Mul(rr_kn, hn::Set(d, k.twisting_dt));
            const Triple with_tilt = madd(p.tilt, hn::Mul(p.along, dot(p.n0, z)), turned(p, z)); // mt is along n'
            const V turned_by = hn::Mul(rate, spin_n);
            const Triple mt = {closed(p, hn::NegMulAdd(p.n.x, turned_by, with_tilt.x)),
                               closed(p, hn::NegMulAdd(p.n.y, turned_by, with_tilt.y)),
                               closed(p, hn::NegMulAdd(p.n.z, turned_by, with_tilt.z))};
            store3(mt, h + at_twisting * lanes);
            moment = Rolling ? plus(moment, mt) : mt;
          }
      }
    return moment;
  }

  static void run(const KernelView &view)
  {
    const KernelView k = view; // a copy that no store can alias
    for (std::size_t b = k.begin; b < k.end; ++b)
      {
        std::uint8_t touched = 0;
        for (std::size_t l = 0; l < lanes; l += hn::Lanes(D()))
          sub_block(k, b * lanes + l, l, k.history + b * n_components * lanes + l, k.occupied[b], touched);
        k.occupied[b] = touched;
      }
  }
};

// Each variant is exported under its own name: run-time dispatch works on plain functions.
#define ISOSTAT_VARIANT(NAME, F, R, T, E, P) \
  void NAME(const KernelView &k) { Loop<F, R, T, E, P>::run(k); }
#define ISOSTAT_VARIANTS(SUFFIX, P) \
  ISOSTAT_VARIANT(Frictionless##SUFFIX, false, false, false, false, P) \
  ISOSTAT_VARIANT(Sliding##SUFFIX, true, false, false, false, P) \
  ISOSTAT_VARIANT(Rolling##SUFFIX, true, true, false, false, P) \
  ISOSTAT_VARIANT(Twisting##SUFFIX, true, false, true, false, P) \
  ISOSTAT_VARIANT(Full##SUFFIX, true, true, true, false, P) \
  ISOSTAT_VARIANT(SlidingEnergy##SUFFIX, true, false, false, true, P) \
  ISOSTAT_VARIANT(RollingEnergy##SUFFIX, true, true, false, true, P) \
  ISOSTAT_VARIANT(TwistingEnergy##SUFFIX, true, false, true, true, P) \
  ISOSTAT_VARIANT(FullEnergy##SUFFIX, true, true, true, true, P)
ISOSTAT_VARIANTS(InBox, false)
ISOSTAT_VARIANTS(InCell, true)
#undef ISOSTAT_VARIANTS
#undef ISOSTAT_VARIANT

/// Adds to each grain what its ghosts have, and clears them.
void AddGhosts(const Ghost *ghosts, std::size_t n, double *action)
{
  const D d;
  for (std::size_t g = 0; g < n; ++g)
    for (std::size_t c = 0; c < 8; c += hn::Lanes(d))
      {
        double *grain = action + 8 * std::size_t{ghosts[g].grain} + c,
               *ghost = action + 8 * std::size_t{ghosts[g].slot} + c;
        hn::Store(hn::Add(hn::Load(d, grain), hn::Load(d, ghost)), d, grain);
        hn::Store(hn::Zero(d), d, ghost);
      }
}

const char *InstructionSet() { return hwy::TargetName(HWY_TARGET); }
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
#define ISOSTAT_EXPORT(SUFFIX) \
  HWY_EXPORT(Frictionless##SUFFIX); \
  HWY_EXPORT(Sliding##SUFFIX); \
  HWY_EXPORT(Rolling##SUFFIX); \
  HWY_EXPORT(Twisting##SUFFIX); \
  HWY_EXPORT(Full##SUFFIX); \
  HWY_EXPORT(SlidingEnergy##SUFFIX); \
  HWY_EXPORT(RollingEnergy##SUFFIX); \
  HWY_EXPORT(TwistingEnergy##SUFFIX); \
  HWY_EXPORT(FullEnergy##SUFFIX)
ISOSTAT_EXPORT(InBox);
ISOSTAT_EXPORT(InCell);
HWY_EXPORT(AddGhosts);
HWY_EXPORT(InstructionSet);

namespace
{
#define ISOSTAT_RUN(SUFFIX) \
  void run##SUFFIX(LawFeatures on, bool energy, const KernelView &view) \
  { \
    if (on.rolling && on.twisting) \
      energy ? HWY_DYNAMIC_DISPATCH(FullEnergy##SUFFIX)(view) : HWY_DYNAMIC_DISPATCH(Full##SUFFIX)(view); \
    else if (on.rolling) \
      energy ? HWY_DYNAMIC_DISPATCH(RollingEnergy##SUFFIX)(view) : HWY_DYNAMIC_DISPATCH(Rolling##SUFFIX)(view); \
    else if (on.twisting) \
      energy ? HWY_DYNAMIC_DISPATCH(TwistingEnergy##SUFFIX)(view) : HWY_DYNAMIC_DISPATCH(Twisting##SUFFIX)(view); \
    else if (on.friction) \
      energy ? HWY_DYNAMIC_DISPATCH(SlidingEnergy##SUFFIX)(view) : HWY_DYNAMIC_DISPATCH(Sliding##SUFFIX)(view); \
    else \
      HWY_DYNAMIC_DISPATCH(Frictionless##SUFFIX)(view); \
  }
ISOSTAT_RUN(InBox)
ISOSTAT_RUN(InCell)

void run(LawFeatures on, const KernelView &view)
{
  const bool energy = view.sliding != nullptr;
  view.image ? runInCell(on, energy, view) : runInBox(on, energy, view);
}
} // namespace

void add_contact_forces(const LawParams &law, const Packing &packing, double dt, ContactList &list, std::size_t chunk,
                        double *action, DissipationPerPair *dissipation, const CellMotion *cell)
{
  const double shear = law.stiffness_ratio * dt;
  KernelView view{.position = packing.position.data(),
                  .velocity = packing.velocity.data(),
                  .spin = packing.spin.data(),
                  .first = list.first(),
                  .second = list.second(),
                  .target = list.target(),
                  .history = list.history_data(),
                  .action = action,
                  .occupied = list.occupied(),
                  .begin = list.first_block(chunk),
                  .end = list.first_block(chunk + 1),
                  .friction = law.friction,
                  .rolling_limit = law.rolling_limit,
                  .dt = dt,
                  .twice_young = 2 * law.young,
                  .half_dt = 0.5 * dt,
                  .shear_dt = shear,
                  .rolling_dt = shear * law.rolling_stiffness,
                  .twisting_dt = shear * law.twisting_stiffness,
                  .stiffness_ratio = law.stiffness_ratio,
                  .rolling_stiffness = law.rolling_stiffness,
                  .twisting_stiffness = law.twisting_stiffness};
  if (list.image())
    {
      const Mat3 &e = cell->strain_step;
      const double steps[] = {e(0, 0), e(1, 1), e(2, 2), e(1, 2), e(0, 2), e(0, 1)};
      for (int c = 0; c < 6; ++c)
        view.rate[c] = steps[c] / dt;
      view.image = list.image();
      view.offsets = list.offsets();
      view.virial = cell->virial->data(chunk);
      view.virial_start = cell->virial->grid();
    }
  if (!dissipation)
    return run(list.features(), view);
  dissipation->clear(view.begin * ContactList::lanes, view.end * ContactList::lanes);
  view.sliding = dissipation->sliding.data();
  view.rolling = dissipation->rolling.data();
  view.released = dissipation->released.data();
  view.created = dissipation->created.data();
  run(list.features(), view);
}

void add_ghosts(const ContactList &list, std::size_t chunk, double *action)
{
  HWY_DYNAMIC_DISPATCH(AddGhosts)(list.ghosts(chunk).data(), list.ghosts(chunk).size(), action);
}

void add_contact_forces(const LawParams &law, const Packing &packing, double dt, ContactList &list, double *action,
                        DissipationPerPair *dissipation, const CellMotion *cell)
{
  if (dissipation)
    dissipation->resize(list.n_lanes());
  for (std::size_t chunk = 0; chunk < list.partition().n_chunks; ++chunk)
    add_contact_forces(law, packing, dt, list, chunk, action, dissipation, cell);
  for (std::size_t chunk = 0; chunk < list.partition().n_chunks; ++chunk)
    add_ghosts(list, chunk, action);
}

std::string instruction_set() { return HWY_DYNAMIC_DISPATCH(InstructionSet)(); }
} // namespace isostat
#endif
