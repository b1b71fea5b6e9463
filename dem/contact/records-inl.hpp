// SPDX-License-Identifier: BSD-3-Clause
// Four-wide grain records to vectors of lanes and back, by transposition in registers. Included once per instruction
// set by SIMD sources (hence no #pragma once); `records` below are [x y z w] x 8 bytes, `actions` [F 0 T 0].
#if defined(ISOSTAT_RECORDS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOSTAT_RECORDS_INL_HPP
#undef ISOSTAT_RECORDS_INL_HPP
#else
#define ISOSTAT_RECORDS_INL_HPP
#endif

#include <cstdint>
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

struct Quad
{
  Triple xyz;
  V w;
};

HWY_INLINE Triple plus(const Triple &a, const Triple &b)
{
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Triple minus(const Triple &a, const Triple &b)
{
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Triple negated(const Triple &a) { return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)}; }
HWY_INLINE Triple scaled(const Triple &a, V s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
HWY_INLINE Triple masked(Mask m, const Triple &a)
{
  return {hn::IfThenElseZero(m, a.x), hn::IfThenElseZero(m, a.y), hn::IfThenElseZero(m, a.z)};
}
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

HWY_INLINE Triple load3(const double *h) { return {hn::LoadU(D(), h), hn::LoadU(D(), h + 8), hn::LoadU(D(), h + 16)}; }
HWY_INLINE void store3(const Triple &a, double *h)
{
  hn::StoreU(a.x, D(), h);
  hn::StoreU(a.y, D(), h + 8);
  hn::StoreU(a.z, D(), h + 16);
}

#if HWY_TARGET > HWY_AVX3
HWY_INLINE V inverse(V x) { return hn::Div(hn::Set(D(), 1.0), x); }
HWY_INLINE V inverse_root(V x) { return hn::Div(hn::Set(D(), 1.0), hn::Sqrt(x)); }
HWY_INLINE V root(V x, V) { return hn::Sqrt(x); }
#endif

#if HWY_TARGET <= HWY_AVX3
// Reciprocals by a 14-bit estimate and two Newton steps (28, 56 bits): 5 and 9 operations on two ports where the
// divider would be busy for 16 and 40 cycles. Errors are 1 to 2 units in the last place.
HWY_INLINE V inverse(V x)
{
  const V two = hn::Set(D(), 2.0);
  V y{_mm512_rcp14_pd(x.raw)};
  y = hn::Mul(y, hn::NegMulAdd(x, y, two));
  return hn::Mul(y, hn::NegMulAdd(x, y, two));
}

HWY_INLINE V inverse_root(V x)
{
  const V three_halves = hn::Set(D(), 1.5), half_x = hn::Mul(x, hn::Set(D(), 0.5));
  V y{_mm512_rsqrt14_pd(x.raw)};
  y = hn::Mul(y, hn::NegMulAdd(hn::Mul(half_x, y), y, three_halves));
  return hn::Mul(y, hn::NegMulAdd(hn::Mul(half_x, y), y, three_halves));
}

/// sqrt(x) from y = 1/sqrt(x): one more correction makes it as good as the square root of the processor.
HWY_INLINE V root(V x, V y)
{
  const V r = hn::Mul(x, y);
  return hn::MulAdd(hn::Mul(y, hn::Set(D(), 0.5)), hn::NegMulAdd(r, r, x), r);
}

// ---- 8 lanes: 4 half-loads, 4 interleaves, 4 block shuffles per 8 records
HWY_INLINE __m512d two_records(const double *low, const double *high)
{
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(low)), _mm256_load_pd(high), 1);
}

HWY_INLINE Quad load_records(const double *records, const std::uint32_t *index)
{
  auto at = [&](int l) { return records + 4 * static_cast<std::size_t>(index[l]); };
  const __m512d r02 = two_records(at(0), at(2)), r13 = two_records(at(1), at(3));
  const __m512d r46 = two_records(at(4), at(6)), r57 = two_records(at(5), at(7));
  const __m512d xz03 = _mm512_unpacklo_pd(r02, r13), yw03 = _mm512_unpackhi_pd(r02, r13);
  const __m512d xz47 = _mm512_unpacklo_pd(r46, r57), yw47 = _mm512_unpackhi_pd(r46, r57);
  return {{V{_mm512_shuffle_f64x2(xz03, xz47, 0x88)}, V{_mm512_shuffle_f64x2(yw03, yw47, 0x88)},
           V{_mm512_shuffle_f64x2(xz03, xz47, 0xDD)}},
          V{_mm512_shuffle_f64x2(yw03, yw47, 0xDD)}};
}

/// Records of 8 lanes as four registers (0|2), (1|3), (4|6), (5|7); the fourth component is 0.
struct RecordPairs
{
  __m512d r02, r13, r46, r57;
};

HWY_INLINE RecordPairs to_records(const Triple &a)
{
  const __m512d zero = _mm512_setzero_pd();
  const __m512d xy_even = _mm512_unpacklo_pd(a.x.raw, a.y.raw), xy_odd = _mm512_unpackhi_pd(a.x.raw, a.y.raw);
  const __m512d z_even = _mm512_unpacklo_pd(a.z.raw, zero), z_odd = _mm512_unpackhi_pd(a.z.raw, zero);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
  return {_mm512_permutex2var_pd(xy_even, low, z_even), _mm512_permutex2var_pd(xy_odd, low, z_odd),
          _mm512_permutex2var_pd(xy_even, high, z_even), _mm512_permutex2var_pd(xy_odd, high, z_odd)};
}

HWY_INLINE void add_lane(double *action, __m512d force_torque)
{
  _mm512_store_pd(action, _mm512_add_pd(_mm512_load_pd(action), force_torque));
}
HWY_INLINE void sub_add_lane(double *action, __m512d force_torque)
{
  // grain 1 receives -F and +T1: flip the sign of the lower half
  const __m512d sign = _mm512_castsi512_pd(_mm512_setr_epi64(INT64_MIN, INT64_MIN, INT64_MIN, INT64_MIN, 0, 0, 0, 0));
  _mm512_store_pd(action, _mm512_add_pd(_mm512_load_pd(action), _mm512_xor_pd(force_torque, sign)));
}

HWY_INLINE void add_actions(double *action, const std::uint32_t *first, const std::uint32_t *second,
                            const Triple &force, const Triple &torque1, const Triple &torque2)
{
  const RecordPairs f = to_records(force), t1 = to_records(torque1), t2 = to_records(torque2);
  auto one = [&](int l) { return action + 8 * static_cast<std::size_t>(first[l]); };
  auto two = [&](int l) { return action + 8 * static_cast<std::size_t>(second[l]); };
#define ISOSTAT_ADD_LANE(LANE, REG, HALVES) \
  sub_add_lane(one(LANE), _mm512_shuffle_f64x2(f.REG, t1.REG, HALVES)); \
  add_lane(two(LANE), _mm512_shuffle_f64x2(f.REG, t2.REG, HALVES))
  ISOSTAT_ADD_LANE(0, r02, 0x44);
  ISOSTAT_ADD_LANE(1, r13, 0x44);
  ISOSTAT_ADD_LANE(2, r02, 0xEE);
  ISOSTAT_ADD_LANE(3, r13, 0xEE);
  ISOSTAT_ADD_LANE(4, r46, 0x44);
  ISOSTAT_ADD_LANE(5, r57, 0x44);
  ISOSTAT_ADD_LANE(6, r46, 0xEE);
  ISOSTAT_ADD_LANE(7, r57, 0xEE);
#undef ISOSTAT_ADD_LANE
}
#elif HWY_TARGET <= HWY_AVX2
// ---- 4 lanes
HWY_INLINE Quad load_records(const double *records, const std::uint32_t *index)
{
  auto at = [&](int l) { return _mm256_load_pd(records + 4 * static_cast<std::size_t>(index[l])); };
  const __m256d r0 = at(0), r1 = at(1), r2 = at(2), r3 = at(3);
  const __m256d xz01 = _mm256_unpacklo_pd(r0, r1), yw01 = _mm256_unpackhi_pd(r0, r1);
  const __m256d xz23 = _mm256_unpacklo_pd(r2, r3), yw23 = _mm256_unpackhi_pd(r2, r3);
  return {{V{_mm256_permute2f128_pd(xz01, xz23, 0x20)}, V{_mm256_permute2f128_pd(yw01, yw23, 0x20)},
           V{_mm256_permute2f128_pd(xz01, xz23, 0x31)}},
          V{_mm256_permute2f128_pd(yw01, yw23, 0x31)}};
}

struct RecordPairs
{
  __m256d r[4];
};

HWY_INLINE RecordPairs to_records(const Triple &a)
{
  const __m256d zero = _mm256_setzero_pd();
  const __m256d xy_even = _mm256_unpacklo_pd(a.x.raw, a.y.raw), xy_odd = _mm256_unpackhi_pd(a.x.raw, a.y.raw);
  const __m256d z_even = _mm256_unpacklo_pd(a.z.raw, zero), z_odd = _mm256_unpackhi_pd(a.z.raw, zero);
  return {{_mm256_permute2f128_pd(xy_even, z_even, 0x20), _mm256_permute2f128_pd(xy_odd, z_odd, 0x20),
           _mm256_permute2f128_pd(xy_even, z_even, 0x31), _mm256_permute2f128_pd(xy_odd, z_odd, 0x31)}};
}

HWY_INLINE void add_actions(double *action, const std::uint32_t *first, const std::uint32_t *second,
                            const Triple &force, const Triple &torque1, const Triple &torque2)
{
  const RecordPairs f = to_records(force), t1 = to_records(torque1), t2 = to_records(torque2);
  for (int l = 0; l < 4; ++l)
    {
      double *one = action + 8 * static_cast<std::size_t>(first[l]),
             *two = action + 8 * static_cast<std::size_t>(second[l]);
      _mm256_store_pd(one, _mm256_sub_pd(_mm256_load_pd(one), f.r[l]));
      _mm256_store_pd(one + 4, _mm256_add_pd(_mm256_load_pd(one + 4), t1.r[l]));
      _mm256_store_pd(two, _mm256_add_pd(_mm256_load_pd(two), f.r[l]));
      _mm256_store_pd(two + 4, _mm256_add_pd(_mm256_load_pd(two + 4), t2.r[l]));
    }
}
#else
// ---- any other width: through memory
HWY_INLINE Quad load_records(const double *records, const std::uint32_t *index)
{
  HWY_ALIGN double lanes[4][hn::MaxLanes(D())];
  for (std::size_t l = 0; l < hn::Lanes(D()); ++l)
    for (int c = 0; c < 4; ++c)
      lanes[c][l] = records[4 * static_cast<std::size_t>(index[l]) + c];
  return {{hn::Load(D(), lanes[0]), hn::Load(D(), lanes[1]), hn::Load(D(), lanes[2])}, hn::Load(D(), lanes[3])};
}

HWY_INLINE void add_actions(double *action, const std::uint32_t *first, const std::uint32_t *second,
                            const Triple &force, const Triple &torque1, const Triple &torque2)
{
  HWY_ALIGN double lanes[9][hn::MaxLanes(D())];
  const V components[9] = {force.x, force.y, force.z, torque1.x, torque1.y, torque1.z, torque2.x, torque2.y, torque2.z};
  for (int c = 0; c < 9; ++c)
    hn::Store(components[c], D(), lanes[c]);
  for (std::size_t l = 0; l < hn::Lanes(D()); ++l)
    {
      double *one = action + 8 * static_cast<std::size_t>(first[l]),
             *two = action + 8 * static_cast<std::size_t>(second[l]);
      for (int c = 0; c < 3; ++c)
        {
          one[c] -= lanes[c][l];
          one[4 + c] += lanes[3 + c][l];
          two[c] += lanes[c][l];
          two[4 + c] += lanes[6 + c][l];
        }
    }
}
#endif

/// Central forces only: +F on the second grain, -F on the first.
HWY_INLINE void add_forces(double *action, const std::uint32_t *first, const std::uint32_t *second, const Triple &force)
{
  HWY_ALIGN double lanes[3][hn::MaxLanes(D())];
  hn::Store(force.x, D(), lanes[0]);
  hn::Store(force.y, D(), lanes[1]);
  hn::Store(force.z, D(), lanes[2]);
  for (std::size_t l = 0; l < hn::Lanes(D()); ++l)
    {
      double *one = action + 8 * static_cast<std::size_t>(first[l]),
             *two = action + 8 * static_cast<std::size_t>(second[l]);
      for (int c = 0; c < 3; ++c)
        {
          one[c] -= lanes[c][l];
          two[c] += lanes[c][l];
        }
    }
}
} // namespace HWY_NAMESPACE
} // namespace isostat
HWY_AFTER_NAMESPACE();
#endif
