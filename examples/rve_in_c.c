/* SPDX-License-Identifier: BSD-3-Clause */
/* A packing as a material point of a program in C: simple shear with closed pores, as a finite-element program would
 * ask for it. Each increment is tried twice as large first and taken back, as a Newton iteration does; half way the
 * element goes through a restart file; at the end the pores are opened. What to see: shear stress and normal stresses
 * change, the void ratio does not until the pores are open; rve_in_cpp.cpp and rve_in_fortran.f90 give the same digits.
 *
 *     rve_in_c SPECIMEN      a periodic specimen (.h5), or library.h5#s0001
 */
#include "dem/rve/isostat_rve.h"

#include <stdio.h>
#include <stdlib.h>

/* Ends the program where the packing cannot do what is asked for. A finite-element program would divide its step. */
static void must(isostat_status status)
{
  if (status == ISOSTAT_OK)
    return;
  fprintf(stderr, "%s\n", isostat_rve_error());
  exit(1);
}

static void print_row(const isostat_rve *rve, int n)
{
  double s[6], e;
  must(isostat_rve_stress(rve, s));
  must(isostat_rve_void_ratio(rve, &e));
  printf("%d %.17g %.17g %.17g %.17g %.17g\n", n, s[0], s[1], s[2], s[5], e);
}

/* Writes the element into a file, and reads it back as another process would. */
static isostat_rve *restarted(isostat_rve *rve)
{
  size_t size;
  must(isostat_rve_pack(rve, NULL, &size));
  void *bytes = malloc(size);
  FILE *file = tmpfile();
  if (!bytes || !file)
    exit(1);
  must(isostat_rve_pack(rve, bytes, &size));
  isostat_rve_destroy(rve);
  if (fwrite(bytes, 1, size, file) != size)
    exit(1);
  rewind(file);
  if (fread(bytes, 1, size, file) != size)
    exit(1);
  fclose(file);
  isostat_rve *again;
  must(isostat_rve_unpack(bytes, size, NULL, &again));
  free(bytes);
  return again;
}

int main(int argc, char **argv)
{
  const double shear[9] = {0, 1e-4, 0, 0, 0, 0, 0, 0, 0}, twice[9] = {0, 2e-4, 0, 0, 0, 0, 0, 0, 0};
  const int open_pores[6] = {1, 1, 1, 0, 0, 0}; /* normal stresses are kept, shear strains are prescribed */
  double stress[6];
  isostat_rve *rve;
  isostat_rve_state *start = NULL;
  must(isostat_rve_create(argc > 1 ? argv[1] : "specimen.h5", NULL, &rve));
  printf("increment  sigma_xx (Pa)  sigma_yy (Pa)  sigma_zz (Pa)  tau_xy (Pa)  e\n");
  print_row(rve, 0);
  for (int n = 1; n <= 10; ++n)
    {
      must(isostat_rve_save(rve, &start));
      must(isostat_rve_undrained(rve, twice, NULL));
      must(isostat_rve_restore(rve, start));
      must(isostat_rve_undrained(rve, shear, NULL));
      print_row(rve, n);
      if (n == 5)
        rve = restarted(rve);
    }
  must(isostat_rve_stress(rve, stress));
  must(isostat_rve_mixed(rve, shear, stress, open_pores, 1e-3, NULL));
  print_row(rve, 11);
  isostat_rve_state_destroy(start);
  isostat_rve_destroy(rve);
  return 0;
}
