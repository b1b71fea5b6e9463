// SPDX-License-Identifier: BSD-3-Clause
// The loop over contacts for any law: records of grains in, forces, torques, virial and energy sums out. Included once
// per instruction set by the SIMD source of a law (hence no #pragma once).
// tested: tests/dem/contact/loop_test.cpp
#if defined(ISOSTAT_LOOP_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOSTAT_LOOP_INL_HPP
#undef ISOSTAT_LOOP_INL_HPP
#else
#define ISOSTAT_LOOP_INL_HPP
#endif

#include "dem/contact/loop.hpp"
#include "dem/contact/records-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// Pairs of grains, one to a lane, as a law sees them. In lanes that do not touch n is 0, and whatever is not a number
/// there must go through closed().
struct Pairs
{
  V r1, r2, reach;         ///< R1, R2, R1 + R2
  V inv_distance, overlap; ///< 1/L, u
  Triple n;                ///< from the first grain to the second
  Triple dv, w1, w2;       ///< v2 - v1 with the strain of a cell, spins; not set for a central law
  Mask touching;
};

/// 0 in lanes that do not touch.
HWY_INLINE V closed(const Pairs &p, V v) { return hn::IfThenElseZero(p.touching, v); }

/// How history turns with its contact: a = n' x n,  s = (dt/2) [n'.(w1 + w2)] n'
struct Turning
{
  Triple n0, tilt, turn; ///< n', a, a + s
  V along;               ///< s = along n'

  HWY_INLINE Turning(const Pairs &p, const double *normal_before, double half_dt)
  {
    n0 = load3(normal_before);
    tilt = cross(n0, p.n);
    along = hn::Mul(hn::Set(D(), half_dt), dot(n0, plus(p.w1, p.w2)));
    turn = madd(n0, along, tilt);
  }
  /// z - z x (a + s): history that is normal to n' turned with the contact; (z x a) x s = a (s.z) is 0 for it.
  HWY_INLINE Triple turned(const Triple &z) const { return minus_cross(z, turn); }
  /// The same of any history.
  HWY_INLINE Triple turned_whole(const Triple &z) const { return madd(tilt, hn::Mul(along, dot(n0, z)), turned(z)); }
};

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

/// One law over the contacts of a chunk. A law over lanes has
///
///     Numbers                    its parameters as the lanes use them: plain doubles
///     n_components               of its history; 0: no memory. With memory its first three are n', kept by the law
///     is_central                 only a normal force, without history; Energy asks for what the dashpot takes alone
///     normal_stiffness(numbers, pairs) -> V, normal_force(numbers, pairs) -> V          of a central law
///     Contact                    of any other: the pairs, made as Contact(numbers, pairs, history), with
///         kn, fn                 normal stiffness and force
///         shear_force<Energy>(history, view, pair)   fs on the second grain; then history holds n and what else is new
///         moment<Energy>(history, view, pair)        M on it, both acting at the contact point; with Energy they store
///                                what they dissipate in view.sliding, .rolling, .created at `pair`
///     forgotten(numbers, history, r1 r2, reach) -> V       elastic energy that an opening contact forgets
///
/// all HWY_INLINE: the loop and its law become one function. A struct of several triples as a result would go through
/// memory, which is why a Contact is asked for one after the other.
/// Viscous: with a dashpot in each contact (dem/contact/dashpot.hpp).
template <typename Law, bool Energy, bool Periodic, bool Viscous>
struct Loop
{
  using Numbers = typename Law::Numbers;
  static constexpr std::size_t n_components = Law::n_components;
  static constexpr std::size_t lanes = ContactList::lanes;

  static void clear(double *history)
  {
    for (std::size_t c = 0; c < n_components; ++c)
      hn::Store(hn::Zero(D()), D(), history + c * lanes);
  }

  /// dv + D b: what homogeneous strain adds to the relative velocity of the fluctuations.
  static HWY_INLINE Triple with_strain(const LoopView &k, const Triple &dv, const Triple &b)
  {
    const D d;
    auto rate = [&](int c) { return hn::Set(d, k.rate[c]); };
    return {hn::MulAdd(rate(0), b.x, hn::MulAdd(rate(5), b.y, hn::MulAdd(rate(4), b.z, dv.x))),
            hn::MulAdd(rate(5), b.x, hn::MulAdd(rate(1), b.y, hn::MulAdd(rate(3), b.z, dv.y))),
            hn::MulAdd(rate(4), b.x, hn::MulAdd(rate(3), b.y, hn::MulAdd(rate(2), b.z, dv.z)))};
  }

  /// Sums of F b and its transpose, lane by lane: see Virial.
  static HWY_INLINE void add_virial(const LoopView &k, std::size_t lane, const Triple &force, const Triple &b)
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

  /// 1/moment of inertia of both grains.
  struct Inertia
  {
    V first, second;
  };

  /// Sets radii, relative velocity and spins of the pairs, as far as they are needed.   @return set where Viscous
  static HWY_INLINE Inertia load_motion(const LoopView &k, std::size_t pair, const Records &x1, const Triple &branch,
                                        Pairs &p)
  {
    if constexpr (Law::is_central && !Viscous)
      {
        p.r1 = transposed(x1).w;
        p.r2 = hn::Sub(p.reach, p.r1);
        return {p.r1, p.r2}; // not used
      }
    const Quad moving = transposed(
        differences(load_records(k.velocity, k.first + pair), load_records(k.velocity, k.second + pair), x1));
    p.dv = moving.xyz;
    if constexpr (Periodic)
      p.dv = with_strain(k, p.dv, branch);
    p.r1 = moving.w;
    p.r2 = hn::Sub(p.reach, p.r1);
    const Quad spin1 = transposed(load_records(k.spin, k.first + pair)),
               spin2 = transposed(load_records(k.spin, k.second + pair));
    p.w1 = spin1.xyz, p.w2 = spin2.xyz;
    return {spin1.w, spin2.w};
  }

  /// fn less dashpot_force(); 0 where nothing touches.
  static HWY_INLINE V damped(const LoopView &k, const Pairs &p, const Inertia &inverse, V kn, V fn, std::size_t pair)
  {
    const D d;
    const V squares1 = hn::Mul(p.r1, p.r1), squares2 = hn::Mul(p.r2, p.r2);
    const V inverse_mass = // of m*, from I = 2/5 m R^2
        hn::Mul(hn::Set(d, 0.4), hn::MulAdd(squares1, inverse.first, hn::Mul(squares2, inverse.second)));
    const V c = hn::Mul(hn::Set(d, 2 * k.contact_damping), hn::Mul(kn, inverse_root(hn::Mul(kn, inverse_mass))));
    const V speed = dot(p.dv, p.n), drag = hn::Min(closed(p, hn::Mul(c, speed)), fn);
    if constexpr (Energy)
      hn::StoreU(hn::Mul(hn::Mul(drag, speed), hn::Set(d, k.dt)), d, k.viscous + pair);
    return hn::Sub(fn, drag);
  }

  static HWY_INLINE void sub_block(const LoopView &k, const Numbers &law, std::size_t pair, std::size_t lane, double *h,
                                   bool occupied, std::uint8_t &touched)
  {
    const D d;
    Pairs p;
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
      return skip(k, law, pair, h, occupied, transposed(x1).w, p.reach);
    touched = 1;
    // lanes that do not touch get n = 0, no stiffness and an empty history: all they add is an exact 0
    p.n = {closed(p, hn::Mul(branch.x, p.inv_distance)), closed(p, hn::Mul(branch.y, p.inv_distance)),
           closed(p, hn::Mul(branch.z, p.inv_distance))};
    const Inertia inverse = load_motion(k, pair, x1, branch, p);
    if constexpr (Law::is_central)
      {
        V fn = Law::normal_force(law, p);
        if constexpr (Viscous)
          fn = damped(k, p, inverse, Law::normal_stiffness(law, p), fn, pair);
        const Triple force = scaled(p.n, fn);
        if constexpr (Periodic)
          add_virial(k, lane, force, branch);
        add_forces(k.action, k.first + pair, k.target + pair, force);
      }
    else
      {
        if constexpr (Energy)
          store_released(k, law, pair, h, p.touching, hn::Mul(p.r1, p.r2), p.reach);
        const typename Law::Contact contact(law, p, h);
        V fn = contact.fn;
        if constexpr (Viscous)
          fn = damped(k, p, inverse, contact.kn, fn, pair);
        const Triple fs = contact.template shear_force<Energy>(h, k, pair);
        const Triple moment = contact.template moment<Energy>(h, k, pair);

        // F at the contact point: T1 = -(R1-u/2) n x fs - M,  T2 = -(R2-u/2) n x fs + M
        const V half = hn::Set(d, 0.5);
        const Triple force = madd(p.n, fn, fs), couple = cross(p.n, fs);
        if constexpr (Periodic)
          add_virial(k, lane, force, branch);
        add_actions(k.action, k.first + pair, k.target + pair, force,
                    nmsub(couple, hn::NegMulAdd(half, p.overlap, p.r1), moment),
                    nmadd(couple, hn::NegMulAdd(half, p.overlap, p.r2), moment));
      }
  }

  /// A vector of pairs none of which touches: history is forgotten, nothing else happens.
  static void skip(const LoopView &k, const Numbers &law, std::size_t pair, double *h, bool occupied, V r1, V reach)
  {
    if (n_components == 0 || !occupied)
      return;
    if constexpr (Energy)
      store_released(k, law, pair, h, hn::Gt(hn::Zero(D()), hn::Zero(D())), hn::Mul(r1, hn::Sub(reach, r1)), reach);
    clear(h);
  }

  static void store_released(const LoopView &k, const Numbers &law, std::size_t pair, const double *h, Mask touching,
                             V rr, V reach)
  {
    if constexpr (n_components > 0)
      {
        const D d;
        const Triple n0 = load3(h);
        const Mask opened = hn::AndNot(touching, hn::Gt(dot(n0, n0), hn::Zero(d)));
        hn::StoreU(hn::IfThenElseZero(opened, Law::forgotten(law, h, rr, reach)), d, k.released + pair);
      }
  }

  static HWY_NOINLINE void run(const LoopView &view, const Numbers &numbers)
  {
    const LoopView k = view; // copies that no store can alias
    const Numbers law = numbers;
    for (std::size_t b = k.begin; b < k.end; ++b)
      {
        std::uint8_t touched = 0;
        for (std::size_t l = 0; l < lanes; l += hn::Lanes(D()))
          sub_block(k, law, b * lanes + l, l, k.history + b * n_components * lanes + l, k.occupied[b], touched);
        k.occupied[b] = touched;
      }
  }
};

/// The loop of a law in a box or a cell, with or without energy sums, as the view asks for.
template <typename Law>
void run_loop(const LoopView &view, const typename Law::Numbers &numbers)
{
  const auto run = [&]<bool Energy, bool Viscous>() {
    view.image ? Loop<Law, Energy, true, Viscous>::run(view, numbers)
               : Loop<Law, Energy, false, Viscous>::run(view, numbers);
  };
  const bool viscous = view.contact_damping > 0, energy = view.sliding && (viscous || !Law::is_central);
  if (viscous)
    energy ? run.template operator()<true, true>() : run.template operator()<false, true>();
  else
    energy ? run.template operator()<true, false>() : run.template operator()<false, false>();
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();
#endif
