// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "base/scene/fragment.hpp"
#include "fem/material/row_material.hpp"

#include <array>
#include <string>
#include <vector>

namespace isostat
{
class SceneDocument;

/// What a scene says of a law that is a shared library.
struct UmatParameters
{
  std::string library;        ///< path; after read_column_scene() an absolute one
  std::vector<double> props;  ///< PROPS
  std::vector<double> statev; ///< STATEV in situ, of every point; what it does not name is 0
  unsigned nstatv = 0;        ///< NSTATV; 0: as many as `statev` has

  bool operator==(const UmatParameters &) const = default;
};

/// layer.umat.library and so on.
SceneFragment<UmatParameters> umat_keys();
/// @param prefix  where the keys are, "layer.0"   @throws InputError   tested: tests/apps/deposit/umat_layer_test.cpp
void check_umat(const SceneDocument &document, const std::string &prefix, const UmatParameters &law);

/// Loads a library unless it has been loaded. It stays until the program ends.
/// @throws InputError  it cannot be loaded, or has no `umat_`: what is wrong and a remedy, to follow a place
void load_umat(const std::string &library);

/// Where a point is, for the law and for messages.
struct UmatPoint
{
  int number = 1;                 ///< NOEL
  std::array<double, 3> coords{}; ///< COORDS, m
  std::string name = {};          ///< "layer.0 (sand), depth 2.5 m"
};

/// A law in a shared library with the interface of the user subroutine UMAT of Abaqus (Abaqus User Subroutines
/// Reference Guide, 1.1.44), in Fortran or any language that exports the symbol `umat_`. Small strain in three
/// dimensions: NDI = NSHR = 3, NTENS = 6, order 11, 22, 33, 12, 13, 23 with x, y, z = 1, 2, 3, shear strain as gamma,
/// tension positive, stress effective. Units are SI, so that PROPS that are stresses are in Pa.
///
///     NOEL, COORDS   of the point; NPT = LAYER = KSPT = KSTEP = 1
///     KINC           1 for the call in situ, 2 for the first increment
///     DTIME, TIME    the time step of waves; 1 s for each increment where there is none (statics)
///     CMNAME         the name of the layer in capitals
///     DROT, DFGRD0, DFGRD1 = 1; TEMP, PREDEF and their increments = 0; CELENT = 0
///
/// A call in situ with DSTRAN = 0 begins: STRESS has to stay within 1 %, STATEV becomes what it leaves. Every later
/// call starts from what the last committed one left. DDSDDE is the tangent of Newton's method, and its wave moduli
/// (max_wave_moduli()) bound the time step: those in situ, found again by a call with DSTRAN = 0 where p' has risen by
/// a quarter; they never fall. A law has to fill it then, too. PNEWDT < 1 rejects an increment.
///
/// One call at a time in a process, so that COMMON and SAVE do no harm; but what a law keeps there is in no checkpoint,
/// and rejected increments change it.
/// tested: tests/fem/material/umat_test.cpp, tests/apps/umat_test.py
class Umat : public RowMaterial
{
public:
  /// @param name  CMNAME   @param points  each of them
  /// @throws InputError  as load_umat()
  Umat(const UmatParameters &law, const std::string &name, std::vector<UmatPoint> points);

  /// @throws InputError naming the point  the law moves the stress, or its DDSDDE carries no wave
  void set_initial_stress(std::span<const Stress> effective) override;
  void set_time_step(double seconds) override { dtime_ = seconds > 0 ? seconds : 1; }
  /// @throws RunFailure naming the point  PNEWDT < 1, or a strain or stress that is not a number
  void trial(std::span<const Gradient> increments, std::span<Stress> stresses) override;
  void commit() override;
  void stiffness(std::span<Stiffness> tangents) const override;
  void wave_moduli(std::span<WaveModuli> moduli) const override;

  /// Its state variables, committed.
  std::span<const double> statev(std::size_t point) const;

private:
  enum : std::size_t // one point, as UMAT has it
  {
    stran = 6,     ///< after STRESS
    energies = 12, ///< SSE, SPD, SCD
    time = 15,
    kinc,     ///< increments that are behind it
    pressure, ///< p' at which the wave moduli were found, Pa
    waves,
    first_statev = waves + 2
  };
  using Tangent = std::array<double, 36>; ///< DDSDDE, column by column

  std::string at(std::size_t point) const;
  double call(std::size_t point, double *row, const Stress &dstran, Tangent &ddsdde) const;
  Tangent still_tangent(std::size_t point) const;
  void find_waves(std::size_t point, double *row, const Tangent &ddsdde) const;

  UmatParameters law_;
  void (*function_)() = nullptr; ///< umat_
  std::string name_;             ///< CMNAME, 80 letters
  std::vector<UmatPoint> points_;
  std::size_t stride_;
  double dtime_ = 1;
  std::vector<Tangent> tangents_; ///< of the last trial
};
} // namespace isostat
