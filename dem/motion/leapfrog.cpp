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
  double dt, damping;

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

template <bool Measure, bool Affine>
MotionReport integrate_range(Packing &packing, std::size_t begin, std::size_t end, double *action,
                             const LeapfrogStep &how)
{
  const D4 d;
  const Advance advance{how.dt, how.damping};
  constexpr std::size_t width = hn::MaxLanes(D4());
  const V4 limit2 = hn::Set(d, how.speed_limit * how.speed_limit), step = hn::Set(d, advance.dt);
  V4 loss = hn::Zero(d), maximum = hn::Zero(d);
  auto sane = hn::Ge(maximum, maximum);
  double *x = packing.position.data() + 4 * begin, *v = packing.velocity.data() + 4 * begin,
         *w = packing.spin.data() + 4 * begin;
  action += 8 * begin;
  V4 columns[3][4 / width]; // of A - I
  if constexpr (Affine)
    for (int k = 0; k < 3; ++k)
      for (std::size_t half = 0; half < 4; half += width)
        columns[k][half / width] = hn::Load(d, how.affine->columns + 4 * k + half);
  for (std::size_t i = begin; i < end; ++i, x += 4, v += 4, w += 4, action += 8)
    {
      const V4 inverse_mass = hn::Set(d, v[3]), inverse_inertia = hn::Set(d, w[3]);
      const double at[3] = {x[0], x[1], x[2]};
      for (std::size_t half = 0; half < 4; half += width)
        {
          const V4 v_new =
              advance.velocity<Measure>(hn::Load(d, v + half), hn::Load(d, action + half), inverse_mass, loss);
          const V4 w_new =
              advance.velocity<Measure>(hn::Load(d, w + half), hn::Load(d, action + 4 + half), inverse_inertia, loss);
          hn::Store(v_new, d, v + half);
          hn::Store(w_new, d, w + half);
          hn::Store(hn::Zero(d), d, action + half);
          hn::Store(hn::Zero(d), d, action + 4 + half);
          // the record's fourth lane (1/mass) is no velocity
          const auto moving = hn::FirstN(d, 3 - half);
          const V4 speed = hn::IfThenElseZero(moving, v_new);
          V4 x_new = hn::MulAdd(step, speed, hn::Load(d, x + half));
          if constexpr (Affine)
            {
              V4 way = hn::Mul(step, speed); // the sum of small steps first
              for (int k = 0; k < 3; ++k)
                way = hn::MulAdd(columns[k][half / width], hn::Set(d, at[k]), way);
              x_new = hn::Add(way, hn::Load(d, x + half));
            }
          hn::Store(x_new, d, x + half);
          const V4 speed2 = hn::Mul(speed, speed);
          maximum = hn::Max(maximum, speed2);
          // false for not-a-number, too; a spin only has to be a number
          sane = hn::And(sane, hn::And(hn::Lt(speed2, limit2), hn::Eq(w_new, w_new)));
        }
    }
  MotionReport report;
  report.max_speed = std::sqrt(3 * hn::GetLane(hn::MaxOfLanes(d, maximum)));
  report.exploded = !hn::AllTrue(d, sane);
  if constexpr (Measure)
    report.damping_loss = hn::GetLane(hn::SumOfLanes(d, loss));
  return report;
}

/// Damps the grains on which neither force nor torque acts.   @return J that they lose
double damp_free_grains(Packing &packing, std::size_t begin, std::size_t end, const double *action,
                        const FreeGrainDamping &free)
{
  const D4 d;
  double loss = 0;
  for (std::size_t i = begin; i < end; ++i)
    {
      V4 largest = hn::Zero(d);
      for (std::size_t k = 0; k < 8; k += hn::MaxLanes(d))
        largest = hn::Max(largest, hn::Abs(hn::Load(d, action + 8 * i + k)));
      if (hn::AllTrue(d, hn::Eq(largest, hn::Zero(d))))
        loss += free.damp(&packing.position[4 * i], &packing.velocity[4 * i], &packing.spin[4 * i]);
    }
  return loss;
}

MotionReport leapfrog(Packing &packing, std::size_t begin, std::size_t end, double *action, const LeapfrogStep &how)
{
  const auto run = how.affine ? (how.measure_damping ? integrate_range<true, true> : integrate_range<false, true>)
                              : (how.measure_damping ? integrate_range<true, false> : integrate_range<false, false>);
  const double free_loss = how.free ? damp_free_grains(packing, begin, end, action, *how.free) : 0;
  MotionReport report = run(packing, begin, end, action, how);
  report.free_loss = free_loss;
  return report;
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
