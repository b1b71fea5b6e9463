// SPDX-License-Identifier: BSD-3-Clause
#include "apps/deposit/layer_tables.hpp"

#include "base/error.hpp"
#include "base/files/csv_table.hpp"
#include "base/scene/reader.hpp"

#include <array>
#include <fmt/format.h>

namespace isostat
{
namespace
{
struct Column
{
  const char *key, *unit;
};
constexpr std::array columns = {Column{"thickness", "m"}, Column{"shear_velocity", "m/s"}, Column{"density", "kg/m3"}};

std::vector<toml::table> read_rows(const std::string &path)
{
  std::vector<std::string> names;
  for (const Column &column : columns)
    names.push_back(fmt::format("{} ({})", column.key, column.unit));
  const CsvTable table(path, names);
  if (table.n_rows() == 0)
    reject(path, 2, "the table has no rows; give one for each layer, from the surface down");
  std::vector<toml::table> rows(table.n_rows());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < columns.size(); ++k)
      {
        if (!(table(i, k) > 0))
          reject(path, table.line(i),
                 fmt::format("{} = {} {}; must be > 0 {}; correct it or take the row out", columns[k].key,
                             number_text(table(i, k)), columns[k].unit, columns[k].unit));
        rows[i].insert(columns[k].key, fmt::format("{} {}", table(i, k), columns[k].unit));
      }
  return rows;
}

void check_layer(const SceneDocument &document, const std::string &prefix)
{
  if (const toml::node *material = document.find(prefix + ".material"); material && material->is_string())
    if (const std::string &word = material->as_string()->get();
        word != "elastic" && word != "iwan" && word != "mohr_coulomb")
      document.refuse(prefix + ".table", fmt::format("does not belong to a layer of material \"{}\", only to elastic, "
                                                     "iwan and mohr_coulomb. Remove it or change the material.",
                                                     word));
  for (const char *key : {"thickness", "shear_velocity", "shear_modulus", "density"})
    if (const std::string path = fmt::format("{}.{}", prefix, key); document.find(path))
      document.refuse(path, fmt::format("excludes table ({}), whose rows give it. Keep one of them.",
                                        document.where(prefix + ".table")));
}
} // namespace

void expand_layer_tables(SceneDocument &document, const std::string &scene_path)
{
  const toml::node *layers = document.find("layer");
  if (!layers || !layers->is_array_of_tables())
    return;
  for (std::size_t i = layers->as_array()->size(); i-- > 0;) // from the last: numbers of those before stay as they are
    {
      const std::string prefix = fmt::format("layer.{}", i), path = prefix + ".table";
      const toml::node *file = document.find(path);
      if (!file)
        continue;
      if (!file->is_string())
        document.refuse(path, "must be text. Give the path of a CSV file in quotes.");
      check_layer(document, prefix);
      const std::string found = found_file(document, path, scene_path, file->as_string()->get());
      document.repeat("layer", i, "table", read_rows(found));
    }
}
} // namespace isostat
