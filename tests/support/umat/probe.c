/* SPDX-License-Identifier: BSD-3-Clause */
/* A UMAT that writes into STATEV what it is called with.
 *
 * PROPS = [G, nu, fault, size]: from |DSTRAN| > size on, and without strain if size = 0, it is wrong in this way:
 * 1 PNEWDT = 0.25, 2 a stress that is not a number, 3 a stress that moves, 4 DDSDDE stays empty. Or, without strain,
 * 5 normal strain along z adds stress in the plane, as in flow that is not associated: DDSDDE is not symmetric. */
#include <math.h>
#include <stddef.h>

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
           const int *npt, const int *layer, const int *kspt, const int *kstep, const int *kinc, size_t name_length)
{
  const double shear = props[0], lame = 2 * shear * props[1] / (1 - 2 * props[1]);
  const int fault = (int)props[2];
  double largest = 0;
  int i, j;
  for (i = 0; i < 6; ++i)
    largest = fmax(largest, fabs(dstran[i]));
  for (i = 0; i < 6; ++i)
    for (j = 0; j < 6; ++j)
      {
        const double c = (i < 3 && j < 3 ? lame : 0) + (i == j ? (i < 3 ? 2 : 1) * shear : 0);
        stress[i] += c * dstran[j];
        ddsdde[i + 6 * j] = c;
      }
  if (largest > props[3] || (largest == 0 && props[3] == 0))
    {
      *pnewdt = fault == 1 ? 0.25 : 1;
      stress[0] = fault == 2 ? NAN : fault == 3 ? 0.9 * stress[0] : stress[0];
      for (i = 0; fault == 4 && i < 36; ++i)
        ddsdde[i] = 0;
      if (fault == 5)
        ddsdde[4 + 6 * 2] = shear; /* from eps_z to tau_xz */
    }
  if (*nstatv < 20)
    return;
  {
    const double called[19] = {
        *kinc,   time[0], time[1], *dtime, *noel,    coords[0], coords[1], coords[2], cmname[0],          cmname[79],
        *nprops, *ndi,    *nshr,   *ntens, stran[4], dstran[4], drot[4],   dfgrd1[8], (double)name_length};
    for (i = 0; i < 19; ++i)
      statev[i] = called[i];
    statev[19] += 1; /* calls that count */
  }
}
