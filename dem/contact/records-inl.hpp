// SPDX-License-Identifier: BSD-3-Clause
// Grain records to vectors of lanes and back. Records are four numbers [x y z w], loaded whole, subtracted as records
// where only the difference is needed, and transposed in registers; `action` is [F 0 T 0]. Included once per
// instruction set by SIMD sources (hence no #pragma once).
// tested: tests/dem/contact/loop_test.cpp
#if defined(ISOSTAT_RECORDS_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef ISOSTAT_RECORDS_INL_HPP
#undef ISOSTAT_RECORDS_INL_HPP
#else
#define ISOSTAT_RECORDS_INL_HPP
#endif

#include "dem/contact/triple-inl.hpp"

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace isostat
{
namespace HWY_NAMESPACE
{
/// Lanes of records: three components and the fourth number.
struct Quad
{
  Triple xyz;
  V w;
};

#if HWY_TARGET <= HWY_AVX3
/// Records of 8 lanes, two in a register: lanes (0|2), (1|3), (4|6), (5|7).
struct Records
{
  __m512d r02, r13, r46, r57;
};

HWY_INLINE __m512d two_records(const double *low, const double *high)
{
  return _mm512_insertf64x4(_mm512_castpd256_pd512(_mm256_load_pd(low)), _mm256_load_pd(high), 1);
}

HWY_INLINE Records load_records(const double *records, const std::uint32_t *index)
{
  auto at = [&](int l) { return records + 4 * static_cast<std::size_t>(index[l]); };
  return {two_records(at(0), at(2)), two_records(at(1), at(3)), two_records(at(4), at(6)), two_records(at(5), at(7))};
}

HWY_INLINE Quad transposed(const Records &r)
{
  const __m512d xz03 = _mm512_unpacklo_pd(r.r02, r.r13), yw03 = _mm512_unpackhi_pd(r.r02, r.r13);
  const __m512d xz47 = _mm512_unpacklo_pd(r.r46, r.r57), yw47 = _mm512_unpackhi_pd(r.r46, r.r57);
  return {{V{_mm512_shuffle_f64x2(xz03, xz47, 0x88)}, V{_mm512_shuffle_f64x2(yw03, yw47, 0x88)},
           V{_mm512_shuffle_f64x2(xz03, xz47, 0xDD)}},
          V{_mm512_shuffle_f64x2(yw03, yw47, 0xDD)}};
}

/// x2 - x1 and w1 + w2
HWY_INLINE Records differences_and_sum(const Records &one, const Records &two)
{
  const __m512d sign = _mm512_setr_pd(-1, -1, -1, 1, -1, -1, -1, 1);
  auto f = [&](__m512d a, __m512d b) { return _mm512_fmadd_pd(a, sign, b); };
  return {f(one.r02, two.r02), f(one.r13, two.r13), f(one.r46, two.r46), f(one.r57, two.r57)};
}

/// x2 - x1, and the fourth number of `fourth`
HWY_INLINE Records differences(const Records &one, const Records &two, const Records &fourth)
{
  auto f = [](__m512d a, __m512d b, __m512d c) { return _mm512_mask_sub_pd(c, 0x77, b, a); };
  return {f(one.r02, two.r02, fourth.r02), f(one.r13, two.r13, fourth.r13), f(one.r46, two.r46, fourth.r46),
          f(one.r57, two.r57, fourth.r57)};
}

HWY_INLINE Records sums(const Records &a, const Records &b)
{
  return {_mm512_add_pd(a.r02, b.r02), _mm512_add_pd(a.r13, b.r13), _mm512_add_pd(a.r46, b.r46),
          _mm512_add_pd(a.r57, b.r57)};
}

/// Back to records with a fourth number of 0.
HWY_INLINE Records to_records(const Triple &a)
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
/// Grain 1 receives -F and +T1.
HWY_INLINE void sub_add_lane(double *action, __m512d force_torque)
{
  const __m512d sign = _mm512_setr_pd(-1, -1, -1, -1, 1, 1, 1, 1);
  _mm512_store_pd(action, _mm512_fmadd_pd(force_torque, sign, _mm512_load_pd(action)));
}

HWY_INLINE void add_actions(double *action, const std::uint32_t *first, const std::uint32_t *second,
                            const Triple &force, const Triple &torque1, const Triple &torque2)
{
  const Records f = to_records(force), t1 = to_records(torque1), t2 = to_records(torque2);
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
/// Records of 4 lanes, one in a register.
struct Records
{
  __m256d r[4];
};

HWY_INLINE Records load_records(const double *records, const std::uint32_t *index)
{
  auto at = [&](int l) { return _mm256_load_pd(records + 4 * static_cast<std::size_t>(index[l])); };
  return {{at(0), at(1), at(2), at(3)}};
}

HWY_INLINE Quad transposed(const Records &r)
{
  const __m256d xz01 = _mm256_unpacklo_pd(r.r[0], r.r[1]), yw01 = _mm256_unpackhi_pd(r.r[0], r.r[1]);
  const __m256d xz23 = _mm256_unpacklo_pd(r.r[2], r.r[3]), yw23 = _mm256_unpackhi_pd(r.r[2], r.r[3]);
  return {{V{_mm256_permute2f128_pd(xz01, xz23, 0x20)}, V{_mm256_permute2f128_pd(yw01, yw23, 0x20)},
           V{_mm256_permute2f128_pd(xz01, xz23, 0x31)}},
          V{_mm256_permute2f128_pd(yw01, yw23, 0x31)}};
}

HWY_INLINE Records differences_and_sum(const Records &one, const Records &two)
{
  const __m256d sign = _mm256_setr_pd(-1, -1, -1, 1);
  Records d;
  for (int l = 0; l < 4; ++l)
    d.r[l] = _mm256_fmadd_pd(one.r[l], sign, two.r[l]);
  return d;
}

HWY_INLINE Records differences(const Records &one, const Records &two, const Records &fourth)
{
  Records d;
  for (int l = 0; l < 4; ++l)
    d.r[l] = _mm256_blend_pd(_mm256_sub_pd(two.r[l], one.r[l]), fourth.r[l], 0x8);
  return d;
}

HWY_INLINE Records sums(const Records &a, const Records &b)
{
  Records s;
  for (int l = 0; l < 4; ++l)
    s.r[l] = _mm256_add_pd(a.r[l], b.r[l]);
  return s;
}

HWY_INLINE Records to_records(const Triple &a)
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
  const Records f = to_records(force), t1 = to_records(torque1), t2 = to_records(torque2);
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
using Records = Quad;

HWY_INLINE Records load_records(const double *records, const std::uint32_t *index)
{
  HWY_ALIGN double lanes[4][hn::MaxLanes(D())];
  for (std::size_t l = 0; l < hn::Lanes(D()); ++l)
    for (int c = 0; c < 4; ++c)
      lanes[c][l] = records[4 * static_cast<std::size_t>(index[l]) + c];
  return {{hn::Load(D(), lanes[0]), hn::Load(D(), lanes[1]), hn::Load(D(), lanes[2])}, hn::Load(D(), lanes[3])};
}
HWY_INLINE Quad transposed(const Records &r) { return r; }
HWY_INLINE Records differences_and_sum(const Records &one, const Records &two)
{
  return {minus(two.xyz, one.xyz), hn::Add(one.w, two.w)};
}
HWY_INLINE Records differences(const Records &one, const Records &two, const Records &fourth)
{
  return {minus(two.xyz, one.xyz), fourth.w};
}
HWY_INLINE Records sums(const Records &a, const Records &b) { return {plus(a.xyz, b.xyz), hn::Add(a.w, b.w)}; }

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
