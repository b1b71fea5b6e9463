// SPDX-License-Identifier: BSD-3-Clause
// The keys of a law that is a shared library.
#include "base/scene/document.hpp"
#include "fem/material/umat.hpp"

#include <fmt/format.h>

namespace isostat
{
namespace
{
// clang-format off
constexpr Key in_layer[] = {
  {.path = "umat", .table = true, .presence = Presence::optional, .value = "{ library = \"my_umat.so\" }",
   .text = "The law of material \"umat\", for small strain with NTENS = 6; its units are SI."},
  {.path = "umat.library", .field = member<&UmatParameters::library>, .presence = Presence::required,
   .value = "my_umat.so",
   .text = "A shared library with the user subroutine UMAT of Abaqus (symbol `umat_`). The path is like that of "
           "`motion.file`. CMNAME is the name of the layer in capitals."},
  {.path = "umat.props", .field = member<&UmatParameters::props>, .presence = Presence::optional,
   .value = "[80e6, 0.3]", .text = "PROPS, the parameters of the law."},
  {.path = "umat.statev", .field = member<&UmatParameters::statev>, .presence = Presence::optional,
   .value = "[0, 0.7]", .text = "STATEV, its state variables, in situ."},
  {.path = "umat.nstatv", .field = member<&UmatParameters::nstatv>, .presence = Presence::optional, .value = "10",
   .range = {1, 1e7}, .reason = "because more would need 80 MB a point; leave it out for as many as umat.statev has",
   .text = "NSTATV, their number, at least that in `umat.statev`; those that it does not name are 0. Left out: as many "
           "as it has."},
};
// clang-format on
} // namespace

SceneFragment<UmatParameters> umat_keys() { return {in_layer}; }

void check_umat(const SceneDocument &document, const std::string &prefix, const UmatParameters &law)
{
  if (law.nstatv > 0 && law.nstatv < law.statev.size())
    document.refuse(prefix + ".umat.nstatv",
                    fmt::format("must be at least {}, the number of values in umat.statev. Correct one of them.",
                                law.statev.size()));
}
} // namespace isostat
