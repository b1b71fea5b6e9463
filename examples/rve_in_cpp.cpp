// SPDX-License-Identifier: BSD-3-Clause
// The path of rve_in_c.c with the C++ class that the C interface wraps: the same digits.
//
//     rve_in_cpp SPECIMEN      a periodic specimen (.h5)
#include "dem/io/specimen_file.hpp"
#include "dem/rve/rve.hpp"

#include <fmt/format.h>

using namespace isostat;

void print_row(const Rve &rve, int n)
{
  const Mat3 s = rve.stress();
  fmt::print("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", n, s(0, 0), s(1, 1), s(2, 2), s(0, 1), rve.void_ratio());
}

int main(int argc, char **argv)
{
  const RveSettings settings{.motion = controlled_motion()};
  Rve rve(read_specimen(argc > 1 ? argv[1] : "specimen.h5").state, settings);
  Mat3 shear = Mat3::Zero(), twice = Mat3::Zero();
  shear(0, 1) = 1e-4;
  twice(0, 1) = 2e-4;
  fmt::print("increment  sigma_xx (Pa)  sigma_yy (Pa)  sigma_zz (Pa)  tau_xy (Pa)  e\n");
  print_row(rve, 0);
  for (int n = 1; n <= 10; ++n)
    {
      const RveState start = rve.save();
      rve.undrained(twice);
      rve.restore(start);
      rve.undrained(shear);
      print_row(rve, n);
      if (n == 5)
        rve = Rve::unpack(rve.pack(), settings);
    }
  MixedIncrement open_pores{.gradient = shear, .stress = rve.stress()};
  open_pores.controlled.diagonal().setConstant(true);
  rve.advance(open_pores);
  print_row(rve, 11);
}
