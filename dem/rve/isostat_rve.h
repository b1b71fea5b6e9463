/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef ISOSTAT_RVE_H
#define ISOSTAT_RVE_H
#include <stddef.h>
#include <stdint.h>

/// @file
/// The representative volume element (dem/rve/rve.hpp) for programs in C, and in Fortran by the module
/// dem/rve/isostat_rve.f90: a periodic packing as a material point, strain in, stress out.
///
/// Sign      strain and stress: tension positive. Stress is the Cauchy effective stress, Pa.
/// Vectors   of 6: xx, yy, zz, yz, xz, xy. Strains in this form have engineering shear, gamma = 2 eps.
/// Matrices  of 9 or 36 numbers: row by row. A Fortran program hands over transpose(gradient).
/// Returns   an isostat_status; isostat_rve_error() says what went wrong. No function ends the program or lets an
///           exception out. A null pointer is bad input unless the function allows it.
/// Threads   elements are independent; one element, or one state, is for one thread at a time.
///
/// A host whose Newton iteration tries several increments from the same state:
///
///     isostat_rve_save(rve, &start);
///     while (iterating) { isostat_rve_restore(rve, start); isostat_rve_advance(rve, gradient, &response); ... }
///
/// Results are those of the C++ class, bit for bit, whatever was saved and restored on the way.
/// tested: tests/dem/rve/isostat_rve_test.cpp; from C and Fortran, against the installed tree: tests/examples_test.py
#ifdef __cplusplus
extern "C"
{
#endif

/// What functions return.
typedef enum isostat_status
{
  ISOSTAT_OK = 0,
  ISOSTAT_REJECTED = 1,  ///< an increment that cannot be taken: the element is as before. Divide it
  ISOSTAT_BAD_INPUT = 2, ///< bad input; the element is as before
  ISOSTAT_FAILURE = 3 ///< anything else: no memory, a factorisation that fails; restore the element before it continues
} isostat_status;

typedef struct isostat_rve isostat_rve;             ///< an element
typedef struct isostat_rve_state isostat_rve_state; ///< all that an element was at one moment

/// How an element is run. Begin with isostat_rve_default_settings(): later versions may have more members.
typedef struct isostat_rve_settings
{
  double inertial_number; ///< I, the strain rate is at most I sqrt(p0'/density)/d50; in (0, 1), default 1e-4
  double strain_rate;     ///< fixed, 1/s, instead of the inertial number; 0 (default): none
  double damping;         ///< local damping in [0, 1), default 0.2
  double frame[9];        ///< axes of the specimen in the laboratory, a rotation: x_lab = frame x_specimen
  double max_increment;   ///< size of the displacement gradient that one call takes, in (0, 0.1], default 0.01
  uint64_t min_steps;     ///< least number of time steps of an increment, default 1
  uint64_t max_steps;     ///< of one call, default 10,000,000
} isostat_rve_settings;

/// What an increment gave.
typedef struct isostat_rve_response
{
  double stress[6];          ///< after it, Pa; where it was rejected, that before
  double mean_stress_change; ///< of tr(stress)/3, Pa: of the pore pressure, if the total mean stress stays
  double indicator;          ///< of the quasi-static error, dem/drive/rate_control.hpp
  uint64_t steps;            ///< time steps it took
} isostat_rve_response;

/// What the last call of this thread that did not return ISOSTAT_OK had to say: function, value, allowed range, remedy;
/// "" before the first. Never null; valid until the next call of this thread.
const char *isostat_rve_error(void);

/// Those of Isostat's own columns. A null pointer is left alone.
void isostat_rve_default_settings(isostat_rve_settings *settings);

/// Makes an element from a prepared periodic packing at rest.
/// @param specimen  path of a specimen (.h5), of an entry of a library ("library.h5#s0001") or of a snapshot of a run
/// @param settings  null: the defaults
/// @param rve  the handle; null where the call does not return ISOSTAT_OK
/// @return bad input: no such file, a packing in a box, settings out of range. Failure: a cell too narrow
isostat_status isostat_rve_create(const char *specimen, const isostat_rve_settings *settings, isostat_rve **rve);

/// Gives the memory back. Null is allowed. Do not use the handle again.
void isostat_rve_destroy(isostat_rve *rve);

/// Strains the element by a displacement gradient relative to its present shape, F <- (I + H) F.
/// @param gradient  H_ij = du_i/dx_j, row by row (9), laboratory. A rotation in it turns stress and grains
/// @param response  null: not wanted
/// @return rejected: larger than max_increment, not a number, or the run failed; the element is as before
isostat_status isostat_rve_advance(isostat_rve *rve, const double *gradient, isostat_rve_response *response);

/// The same without the volumetric part of ln(I + H): an element whose pores are closed.
isostat_status isostat_rve_undrained(isostat_rve *rve, const double *gradient, isostat_rve_response *response);

/// Prescribed strain in some components, target stress in the others: drained, K0, constant p' and other tests.
/// @param gradient  as above; its symmetric part is 0 in components whose stress is controlled
/// @param stress  targets, Pa (6); used where controlled
/// @param controlled  0: strain is prescribed, else stress (6)
/// @param tolerance  |stress - target| / max(p', 0.05 p0') at the end, > 0; 1e-3 is usual
/// @return as isostat_rve_advance(); rejected, too, where the frame is not the identity, the target needs tension, or a
///         component has strain and stress
isostat_status isostat_rve_mixed(isostat_rve *rve, const double *gradient, const double *stress, const int *controlled,
                                 double tolerance, isostat_rve_response *response);

/// Cauchy effective stress, Pa (6).
isostat_status isostat_rve_stress(const isostat_rve *rve, double *stress);

/// Instantaneous stiffness, d(stress)/d(strain), Pa (36); see dem/measure/stiffness.hpp. It costs a
/// sparse factorisation: 0.3 s for 1,000 grains.
/// @param yielding_contacts_resist  0: contacts at a limit yield on, C is not symmetric; else all are elastic
isostat_status isostat_rve_stiffness(const isostat_rve *rve, int yielding_contacts_resist, double *stiffness);

/// Volume of the pores over that of the grains.
isostat_status isostat_rve_void_ratio(const isostat_rve *rve, double *void_ratio);

/// Density of the skeleton, and with pores full of water, kg/m3; either may be null: not wanted.
/// @param water  density of the water, kg/m3, >= 0
isostat_status isostat_rve_densities(const isostat_rve *rve, double water, double *dry, double *saturated);

/// Time steps since the element was made, rejected increments not counted; continues through pack and unpack, and is
/// not turned back by isostat_rve_restore().
isostat_status isostat_rve_steps(const isostat_rve *rve, uint64_t *steps);

/// Copies the element's state: about 15 numbers a grain and 13 a contact.
/// @param state  in: null, or a state that is written over; out: the handle
isostat_status isostat_rve_save(const isostat_rve *rve, isostat_rve_state **state);

/// Brings the element back to a state of its own, or of an element with the same grains and law, bit for bit.
/// @return bad input: a state of other grains
isostat_status isostat_rve_restore(isostat_rve *rve, const isostat_rve_state *state);

/// Gives the memory back. Null is allowed.
void isostat_rve_state_destroy(isostat_rve_state *state);

/// The whole element as bytes, for restart files and other processes on the same type of machine.
/// @param bytes  null: only the size is asked for
/// @param size  in: bytes there is room for (where bytes is not null); out: bytes of the element as it is now
/// @return bad input: no room; `size` is what it needs
isostat_status isostat_rve_pack(const isostat_rve *rve, void *bytes, size_t *size);

/// Makes the element that isostat_rve_pack() gave, with the same bits, if the settings are the same.
/// @return bad input: bytes of another version, cut short or damaged; settings out of range
isostat_status isostat_rve_unpack(const void *bytes, size_t size, const isostat_rve_settings *settings,
                                  isostat_rve **rve);

#ifdef __cplusplus
}
#endif
#endif
