// SPDX-License-Identifier: BSD-3-Clause
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "dem/motion/leapfrog.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "dem/motion/leapfrog.hpp"

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;
using D4 = hn::CappedTag<double, 4>; // a grain record; two halves where vectors are narrower
using V4 = hn::Vec<D4>;

struct Advance
{
  double dt, damping, kept; ///< kept: share of its velocity that a rattler keeps in a step

  /// The velocity of a rattler; the record's fourth lane stays. Adds to `loss` if asked.
  template <bool Measure>
  HWY_INLINE V4 slowed(V4 v, std::size_t half, V4 inverse_mass, V4 &loss) const
  {
    const D4 d;
    const V4 slow = hn::IfThenElse(hn::FirstN(d, 3 - half), hn::Mul(hn::Set(d, kept), v), v);
    if constexpr (Measure)
      {
        const V4 squares = hn::Mul(hn::Sub(v, slow), hn::Add(v, slow));
        loss = hn::MulAdd(hn::Set(d, 0.5), hn::Div(squares, inverse_mass), loss);
      }
    return slow;
  }

  /// v + dt A with damping; `velocity` keeps its fourth lane because the force's is 0. Adds to `loss` if asked.
  template <bool Measure>
  HWY_INLINE V4 velocity(V4 v, V4 force, V4 inverse_mass, V4 &loss) const
  {
    const D4 d;
    const V4 step = hn::Set(d, dt), half = hn::Set(d, 0.5);
    const V4 a = hn::Mul(force, inverse_mass);
    const V4 mid = hn::MulAdd(hn::Mul(half, step), a, v);
    const V4 power = hn::Mul(a, mid);
    const V4 magnitude = hn::Set(d, damping);
    const V4 signed_damping = hn::IfThenElseZero(hn::Ne(power, hn::Zero(d)), hn::CopySign(magnitude, power));
    const V4 damped = hn::NegMulAdd(a, signed_damping, a);
    if constexpr (Measure)
      {
        const V4 true_mid = hn::MulAdd(hn::Mul(half, step), damped, v);
        loss = hn::MulAdd(hn::Mul(hn::Mul(force, signed_damping), true_mid), step, loss);
      }
    return hn::MulAdd(step, damped, v);
  }
};

/// What velocities are measured against.
enum class Frame
{
  absolute, ///< nothing: a box whose walls push
  affine,   ///< the strain of a cell, which is not part of them
  carried   ///< the homogeneous motion of a box's walls, which is
};

/// The homogeneous motion of a box's walls at a grain, in the step before and in this one. The record's fourth lane,
/// 1/mass, stays as it is.
struct Carried
{
  V4 before, now;

  HWY_INLINE Carried(const CarriedStep &u, std::size_t half, V4 x)
      : before(at(u.before, half, x)), now(at(u.now, half, x))
  {}
  static HWY_INLINE V4 at(const HomogeneousMotion &u, std::size_t half, V4 x)
  {
    const D4 d;
    return hn::MulAdd(hn::Load(d, u.rate + half), x, hn::Load(d, u.shift + half));
  }

  /// What the energy of a grain has gained beyond F . v_mid dt less what was taken from its own motion, J.
  HWY_INLINE V4 work(V4 v, V4 v_new, V4 force, V4 inverse_mass, double dt) const
  {
    const D4 d;
    const V4 own = hn::Sub(v, before), own_new = hn::Sub(v_new, now);
    const V4 sum = hn::Add(v_new, v), own_sum = hn::Add(own_new, own);
    const V4 squares = hn::NegMulAdd(own_sum, hn::Sub(own_new, own), hn::Mul(sum, hn::Sub(v_new, v)));
    const V4 impulse = hn::Mul(force, hn::Set(d, dt));
    return hn::Mul(hn::Set(d, 0.5), hn::NegMulAdd(impulse, hn::Sub(sum, own_sum), hn::Div(squares, inverse_mass)));
  }
};

/// The strain of a cell's step.
struct Affine
{
  static constexpr std::size_t width = hn::MaxLanes(D4());
  V4 columns[3][4 / width]; // of A - I

  explicit Affine(const AffineStep *step)
  {
    for (int k = 0; step && k < 3; ++k)
      for (std::size_t half = 0; half < 4; half += width)
        columns[k][half / width] = hn::Load(D4(), step->columns + 4 * k + half);
  }
  /// What a grain moves in all: the sum of small steps.
  HWY_INLINE V4 way(V4 own, const double (&at)[3], std::size_t half) const
  {
    for (int k = 0; k < 3; ++k)
      own = hn::MulAdd(columns[k][half / width], hn::Set(D4(), at[k]), own);
    return own;
  }
};

/// True where neither force nor torque acts.
HWY_INLINE bool is_free(const double *action)
{
  const D4 d;
  V4 largest = hn::Zero(d);
  for (std::size_t k = 0; k < 8; k += hn::MaxLanes(d))
    largest = hn::Max(largest, hn::Abs(hn::Load(d, action + k)));
  return hn::AllTrue(d, hn::Eq(largest, hn::Zero(d)));
}

/// Sums over grains, lane by lane.
struct Sums
{
  V4 damping, free, carried, max_speed2;
  decltype(hn::Eq(V4(), V4())) sane;

  HWY_INLINE Sums()
  {
    damping = free = carried = max_speed2 = hn::Zero(D4());
    sane = hn::Eq(damping, damping);
  }
  MotionReport report() const
  {
    const D4 d;
    return {std::sqrt(3 * hn::GetLane(hn::MaxOfLanes(d, max_speed2))), !hn::AllTrue(d, sane),
            hn::GetLane(hn::SumOfLanes(d, damping)), hn::GetLane(hn::SumOfLanes(d, free)),
            hn::GetLane(hn::SumOfLanes(d, carried))};
  }
};

template <bool Measure, Frame In, bool DampFree>
MotionReport integrate_range(Packing &packing, std::size_t begin, std::size_t end, double *action,
                             const LeapfrogStep &how)
{
  const D4 d;
  const Advance advance{how.dt, how.damping, 1 - how.free.share};
  const V4 limit2 = hn::Set(d, how.speed_limit * how.speed_limit), step = hn::Set(d, advance.dt);
  Sums sums;
  double *x = packing.position.data() + 4 * begin, *v = packing.velocity.data() + 4 * begin,
         *w = packing.spin.data() + 4 * begin;
  action += 8 * begin;
  const Affine strain(In == Frame::affine ? how.affine : nullptr);
  for (std::size_t i = begin; i < end; ++i, x += 4, v += 4, w += 4, action += 8)
    {
      const V4 inverse_mass = hn::Set(d, v[3]), inverse_inertia = hn::Set(d, w[3]);
      const double at[3] = {x[0], x[1], x[2]};
      const bool slowed = DampFree && is_free(action);
      for (std::size_t half = 0; half < 4; half += hn::MaxLanes(d))
        {
          const V4 x_old = hn::Load(d, x + half), v_old = hn::Load(d, v + half), w_old = hn::Load(d, w + half),
                   force = hn::Load(d, action + half), torque = hn::Load(d, action + 4 + half);
          V4 v_new, w_new = w_old;
          if constexpr (In == Frame::carried)
            {
              const Carried u(*how.carried, half, x_old);
              v_new = hn::Sub(v_old, u.before);
              if (slowed)
                v_new = advance.slowed<Measure>(v_new, half, inverse_mass, sums.free);
              v_new = hn::Add(advance.velocity<Measure>(v_new, force, inverse_mass, sums.damping), u.now);
              if constexpr (Measure)
                sums.carried = hn::Add(sums.carried, u.work(v_old, v_new, force, inverse_mass, advance.dt));
            }
          else
            {
              v_new = slowed ? advance.slowed<Measure>(v_old, half, inverse_mass, sums.free) : v_old;
              v_new = advance.velocity<Measure>(v_new, force, inverse_mass, sums.damping);
            }
          if (slowed)
            w_new = advance.slowed<Measure>(w_new, half, inverse_inertia, sums.free);
          w_new = advance.velocity<Measure>(w_new, torque, inverse_inertia, sums.damping);
          hn::Store(v_new, d, v + half);
          hn::Store(w_new, d, w + half);
          hn::Store(hn::Zero(d), d, action + half);
          hn::Store(hn::Zero(d), d, action + 4 + half);
          // the record's fourth lane (1/mass) is no velocity
          const V4 speed = hn::IfThenElseZero(hn::FirstN(d, 3 - half), v_new), speed2 = hn::Mul(speed, speed);
          if constexpr (In == Frame::affine)
            hn::Store(hn::Add(strain.way(hn::Mul(step, speed), at, half), x_old), d, x + half);
          else
            hn::Store(hn::MulAdd(step, speed, x_old), d, x + half);
          sums.max_speed2 = hn::Max(sums.max_speed2, speed2);
          // false for not-a-number, too; a spin only has to be a number
          sums.sane = hn::And(sums.sane, hn::And(hn::Lt(speed2, limit2), hn::Eq(w_new, w_new)));
        }
    }
  return sums.report();
}

template <bool Measure, Frame In>
MotionReport integrate_in(Packing &packing, std::size_t begin, std::size_t end, double *action, const LeapfrogStep &how)
{
  return how.free.share > 0 ? integrate_range<Measure, In, true>(packing, begin, end, action, how)
                            : integrate_range<Measure, In, false>(packing, begin, end, action, how);
}

MotionReport leapfrog(Packing &packing, std::size_t begin, std::size_t end, double *action, const LeapfrogStep &how)
{
  const auto run = [&]<bool Measure>() {
    const auto in = how.affine    ? integrate_in<Measure, Frame::affine>
                    : how.carried ? integrate_in<Measure, Frame::carried>
                                  : integrate_in<Measure, Frame::absolute>;
    return in(packing, begin, end, action, how);
  };
  return how.measure_damping ? run.template operator()<true>() : run.template operator()<false>();
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace isostat
{
HWY_EXPORT(leapfrog);

MotionReport integrate(Packing &packing, std::size_t begin, std::size_t end, double *action, const LeapfrogStep &how)
{
  return HWY_DYNAMIC_DISPATCH(leapfrog)(packing, begin, end, action, how);
}
} // namespace isostat
#endif
