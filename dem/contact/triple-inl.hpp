// SPDX-License-Identifier: BSD-3-Clause
// Vector algebra over lanes: triples of vectors, reciprocals. Included once per instruction set by SIMD sources (hence
// no #pragma once).
// tested: tests/dem/contact/loop_test.cpp
#if defined(ISOSTAT_TRIPLE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOSTAT_TRIPLE_INL_HPP
#undef ISOSTAT_TRIPLE_INL_HPP
#else
#define ISOSTAT_TRIPLE_INL_HPP
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using Mask = hn::Mask<D>;

/// Three components of as many vectors as there are lanes.
struct Triple
{
  V x, y, z;
};

HWY_INLINE Triple plus(const Triple &a, const Triple &b)
{
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Triple minus(const Triple &a, const Triple &b)
{
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Triple scaled(const Triple &a, V s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
/// a s + b
HWY_INLINE Triple madd(const Triple &a, V s, const Triple &b)
{
  return {hn::MulAdd(a.x, s, b.x), hn::MulAdd(a.y, s, b.y), hn::MulAdd(a.z, s, b.z)};
}
/// b - a s
HWY_INLINE Triple nmadd(const Triple &a, V s, const Triple &b)
{
  return {hn::NegMulAdd(a.x, s, b.x), hn::NegMulAdd(a.y, s, b.y), hn::NegMulAdd(a.z, s, b.z)};
}
/// -a s - b
HWY_INLINE Triple nmsub(const Triple &a, V s, const Triple &b)
{
  return {hn::NegMulSub(a.x, s, b.x), hn::NegMulSub(a.y, s, b.y), hn::NegMulSub(a.z, s, b.z)};
}
HWY_INLINE V dot(const Triple &a, const Triple &b)
{
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE Triple cross(const Triple &a, const Triple &b)
{
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
/// c - a x b
HWY_INLINE Triple minus_cross(const Triple &c, const Triple &a, const Triple &b)
{
  return {hn::NegMulAdd(a.y, b.z, hn::MulAdd(a.z, b.y, c.x)), hn::NegMulAdd(a.z, b.x, hn::MulAdd(a.x, b.z, c.y)),
          hn::NegMulAdd(a.x, b.y, hn::MulAdd(a.y, b.x, c.z))};
}
/// z - z x a
HWY_INLINE Triple minus_cross(const Triple &z, const Triple &a) { return minus_cross(z, z, a); }

/// Components of history, 8 lanes apart.
HWY_INLINE Triple load3(const double *h) { return {hn::LoadU(D(), h), hn::LoadU(D(), h + 8), hn::LoadU(D(), h + 16)}; }
HWY_INLINE void store3(const Triple &a, double *h)
{
  hn::StoreU(a.x, D(), h);
  hn::StoreU(a.y, D(), h + 8);
  hn::StoreU(a.z, D(), h + 16);
}

#if HWY_TARGET <= HWY_AVX3
// Reciprocals by a 14-bit estimate y and a series in e, the error of x y (or x y^2): 4 and 6 operations on two ports
// where the divider would be busy for 16 and 40 cycles. Errors are 1 to 2 units in the last place.
HWY_INLINE V inverse(V x)
{
  const V y{_mm512_rcp14_pd(x.raw)};
  const V e = hn::NegMulAdd(x, y, hn::Set(D(), 1.0)); // 1/x = y (1 + e)(1 + e^2) (1 + O(e^4))
  const V once = hn::MulAdd(y, e, y);
  return hn::MulAdd(once, hn::Mul(e, e), once);
}

HWY_INLINE V inverse_root(V x)
{
  const V y{_mm512_rsqrt14_pd(x.raw)};
  const V e = hn::NegMulAdd(hn::Mul(x, y), y, hn::Set(D(), 1.0)); // y (1 + e/2 + 3/8 e^2 + 5/16 e^3 + O(e^4))
  const V series = hn::MulAdd(hn::MulAdd(e, hn::Set(D(), 0.3125), hn::Set(D(), 0.375)), e, hn::Set(D(), 0.5));
  return hn::MulAdd(series, hn::Mul(y, e), y);
}

/// sqrt(x) from y = 1/sqrt(x): one more correction makes it as good as the square root of the processor.
HWY_INLINE V root(V x, V y)
{
  const V r = hn::Mul(x, y);
  return hn::MulAdd(hn::Mul(y, hn::Set(D(), 0.5)), hn::NegMulAdd(r, r, x), r);
}
#else
HWY_INLINE V inverse(V x) { return hn::Div(hn::Set(D(), 1.0), x); }
HWY_INLINE V inverse_root(V x) { return hn::Div(hn::Set(D(), 1.0), hn::Sqrt(x)); }
HWY_INLINE V root(V x, V) { return hn::Sqrt(x); }
#endif
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();
#endif
