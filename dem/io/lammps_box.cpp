// SPDX-License-Identifier: BSD-3-Clause
#include "dem/io/lammps_box.hpp"

#include "dem/io/lammps.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <fmt/format.h>

namespace isostat
{
Mat3 LammpsBox::edges() const
{
  Mat3 e = (upper - lower).asDiagonal();
  e(0, 1) = xy;
  e(0, 2) = xz;
  e(1, 2) = yz;
  return e;
}

RigidBox LammpsBox::bounds() const
{
  return {lower + Vec3(std::min({0.0, xy, xz, xy + xz}), std::min(0.0, yz), 0),
          upper + Vec3(std::max({0.0, xy, xz, xy + xz}), std::max(0.0, yz), 0)};
}

void LammpsBox::set_bounds(const RigidBox &bounds)
{
  lower = upper = Vec3::Zero();
  const RigidBox lean = this->bounds();
  lower = bounds.lower - lean.lower;
  upper = bounds.upper - lean.upper;
}

std::pair<bool, std::string> LammpsBox::assumed_periodic(const std::string &domain, const char *file) const
{
  if (leans())
    return {true, fmt::format("The {} leans: it is taken for a periodic cell.", file)};
  if (domain == "periodic-cell")
    return {true, ""};
  return {false, fmt::format("A {} does not say what bounds it: the faces are taken for walls.", file)};
}

void LammpsBox::bound(Snapshot &snapshot, bool periodic) const
{
  if (!periodic)
    {
      snapshot.box = {lower, upper};
      return;
    }
  snapshot.cell.emplace();
  snapshot.cell->edges = edges();
  snapshot.cell->reference_volume = snapshot.cell->edges.determinant();
}

std::pair<LammpsBox, std::vector<Vec3>> in_lammps_box(const Snapshot &s)
{
  std::vector<Vec3> centres(s.grains.n_grains());
  for (std::size_t i = 0; i < centres.size(); ++i)
    centres[i] = s.grains.centre(i);
  if (!s.cell)
    return {{s.box.lower, s.box.upper}, centres};
  const Mat3 &e = s.cell->edges, inverse = e.inverse();
  LammpsBox box{Vec3::Zero(), e.diagonal(), e(0, 1), e(0, 2), e(1, 2)};
  const auto inside = [](const Vec3 &part) { return (part.array() >= 0).all() && (part.array() < 1).all(); };
  // A cell has no place in space: it begins at the origin if all grains stand there, else it is laid about it.
  if (!std::ranges::all_of(centres, [&](const Vec3 &x) { return inside(inverse * x); }))
    {
      box.upper = 0.5 * e.diagonal();
      box.lower = -box.upper;
    }
  for (Vec3 &x : centres)
    if (const Vec3 part = inverse * (x - box.lower); !inside(part))
      x -= e * Vec3(part.array().floor());
  return {box, centres};
}

bool fits_lammps(const Snapshot &s)
{
  if (!s.cell)
    return true;
  const Mat3 &e = s.cell->edges;
  return e(1, 0) == 0 && e(2, 0) == 0 && e(2, 1) == 0 && (e.diagonal().array() > 0).all();
}

Snapshot lammps_frame(const Snapshot &snapshot)
{
  if (fits_lammps(snapshot))
    return snapshot;
  const Eigen::HouseholderQR<Mat3> qr(snapshot.cell->edges);
  Mat3 q = qr.householderQ();
  const Mat3 r = qr.matrixQR().triangularView<Eigen::Upper>();
  q = q * Mat3(r.diagonal().array().sign().matrix().asDiagonal()); // right-handed: so are the edges
  Snapshot s = turned(snapshot, q.transpose());
  s.cell->edges = Mat3(s.cell->edges.triangularView<Eigen::Upper>());
  return s;
}
} // namespace isostat
