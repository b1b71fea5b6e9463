/* SPDX-License-Identifier: BSD-3-Clause */
/* Linear elasticity as a UMAT in C, for the material "umat" of a layer (docs/column.md, Materials).
 *
 *     cc -O2 -shared -fPIC -o elastic.so elastic.c
 *
 * PROPS = [G (Pa), nu]. What a law in C needs to know: all arguments are pointers, matrices go column by column,
 * components are 11, 22, 33, 12, 13, 23 with shear strain as gamma, tension positive. */
#include <stddef.h>

void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,
           double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,
           const double *time, const double *dtime, const double *temp, const double *dtemp, const double *predef,
           const double *dpred, const char *cmname, const int *ndi, const int *nshr, const int *ntens,
           const int *nstatv, const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
           const int *npt, const int *layer, const int *kspt, const int *kstep, const int *kinc, size_t name_length)
{
  const double shear = props[0], nu = props[1], lame = 2 * shear * nu / (1 - 2 * nu);
  int i, j;
  for (i = 0; i < 6; ++i)
    for (j = 0; j < 6; ++j)
      ddsdde[i + 6 * j] = (i < 3 && j < 3 ? lame : 0) + (i == j ? (i < 3 ? 2 : 1) * shear : 0);
  for (i = 0; i < 6; ++i)
    for (j = 0; j < 6; ++j)
      stress[i] += ddsdde[i + 6 * j] * dstran[j];
}
