// SPDX-License-Identifier: BSD-3-Clause
// What is in a file: groups, datasets, attributes.
#include "base/files/hdf5_handles.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cassert>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isostat::hdf5
{
namespace
{
/// Type of T in memory; in files the same, since every machine this runs on is little-endian.
template <typename T>
Handle type_of()
{
  if constexpr (std::is_same_v<T, double>)
    return {H5Tcopy(H5T_IEEE_F64LE), H5Tclose};
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    return {H5Tcopy(H5T_STD_U64LE), H5Tclose};
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return {H5Tcopy(H5T_STD_U32LE), H5Tclose};
  else
    {
      Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
      H5Tset_size(type, H5T_VARIABLE);
      H5Tset_cset(type, H5T_CSET_UTF8);
      return type;
    }
}

/// Whether values stored as `stored` arrive unchanged in T.
template <typename T>
bool readable_as(hid_t stored)
{
  const H5T_class_t kind = H5Tget_class(stored);
  if constexpr (std::is_same_v<T, double>)
    return kind == H5T_FLOAT || kind == H5T_INTEGER;
  else if constexpr (std::is_same_v<T, std::string>)
    return H5Tis_variable_str(stored) > 0;
  else
    return kind == H5T_INTEGER && H5Tget_sign(stored) == H5T_SGN_NONE && H5Tget_size(stored) <= sizeof(T);
}

template <typename T>
constexpr const char *kind_name = std::is_same_v<T, double>        ? "real numbers"
                                  : std::is_same_v<T, std::string> ? "text"
                                                                   : "unsigned integers";

/// Values of a dataset or attribute whose type and space are given.
template <typename T, typename Transfer>
std::vector<T> read_values(const FileState &file, const std::string &item, hid_t stored, hid_t space,
                           const Transfer &transfer)
{
  if (!readable_as<T>(stored))
    fail(file, item, fmt::format("it does not hold {}", kind_name<T>));
  const std::size_t n = H5Sget_simple_extent_npoints(space);
  std::vector<T> values(n);
  const auto checked_transfer = [&](hid_t type, void *buffer) {
    if (transfer(type, buffer) < 0)
      fail(file, item, "reading failed");
  };
  if constexpr (std::is_same_v<T, std::string>)
    {
      std::vector<char *> texts(n, nullptr);
      checked_transfer(type_of<T>(), texts.data());
      for (std::size_t i = 0; i < n; ++i)
        values[i] = texts[i] ? texts[i] : "";
      H5Dvlen_reclaim(type_of<T>(), space, H5P_DEFAULT, texts.data());
    }
  else
    checked_transfer(type_of<T>(), values.data());
  return values;
}

/// Hands `values` to `transfer(memory type, buffer)` in the form of HDF5.
template <typename T, typename Transfer>
bool write_values(std::span<const T> values, const Transfer &transfer)
{
  const Handle type = type_of<T>();
  if constexpr (std::is_same_v<T, std::string>)
    {
      std::vector<const char *> pointers;
      for (const std::string &text : values)
        pointers.push_back(text.c_str());
      return transfer(type, static_cast<const void *>(pointers.data())) >= 0;
    }
  else
    return transfer(type, static_cast<const void *>(values.data())) >= 0;
}

bool left_file = false; ///< an external link was met in this turn

/// Properties of access to items by which no link to another file is followed: an untrusted file could name any.
hid_t within_file()
{
  static const hid_t access = [] {
    const hid_t made = H5Pcreate(H5P_LINK_ACCESS);
    H5Pset_elink_cb(
        made,
        [](const char *, const char *, const char *, const char *, unsigned *, hid_t, void *) -> herr_t {
          left_file = true;
          return -1;
        },
        nullptr);
    return made;
  }();
  return access;
}

/// @param missing  the message if there is none
Handle open_item(const FileState &file, const std::string &item, const char *missing = "there is no such item")
{
  assert(file.id >= 0);
  left_file = false;
  const hid_t id = H5Oopen(file.id, item.c_str(), within_file());
  if (left_file)
    missing = "it is a link to another file, which is not followed";
  return checked(id, H5Oclose, file, item, missing);
}

/// A dataset whose values are in the file itself: others would be read from any file that it names.
Handle open_dataset(const FileState &file, const std::string &item)
{
  constexpr const char *missing = "there is no such dataset";
  Handle dataset = open_item(file, item, missing);
  if (H5Iget_type(dataset) != H5I_DATASET)
    fail(file, item, missing);
  const Handle made(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_external_count(made) != 0 || H5Pget_layout(made) == H5D_VIRTUAL)
    fail(file, item, "its values are in another file, which is not read");
  return dataset;
}

template <typename T>
Handle create_dataset(const FileState &file, const std::string &item, hid_t space, hid_t layout)
{
  H5Pset_obj_track_times(layout, false); // the same data are the same bytes
  return checked(H5Dcreate2(file.id, item.c_str(), type_of<T>(), space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose,
                 file, item, "creating the dataset failed (does it exist already?)");
}

/// A dataset that stores what it claims: rows that do not exist would ask for any amount of memory. Deflated zeros
/// take a 1032nd of their size; rows that a resumed run has filled up take nothing.
Handle open_stored(const FileState &file, const std::string &item)
{
  constexpr double most_deflated = 1100, filled_up = 1 << 20;
  Handle dataset = open_dataset(file, item);
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  const auto n = static_cast<double>(H5Sget_simple_extent_npoints(space));
  const auto stored = static_cast<double>(H5Dget_storage_size(dataset));
  if (n < 0 || n * static_cast<double>(H5Tget_size(type)) > most_deflated * stored + filled_up)
    fail(file, item, fmt::format("it claims {:.0f} values, but stores {:.0f} bytes", n, stored));
  return dataset;
}

Shape extent(hid_t dataset)
{
  const Handle space(H5Dget_space(dataset), H5Sclose);
  std::vector<hsize_t> dims(std::max(0, H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return dims.empty() ? Shape{1} : Shape(dims.begin(), dims.end());
}

/// The spaces of some rows of a dataset.
struct Rows
{
  Shape shape;
  hsize_t start[2], count[2];
  Handle in_file, in_memory;

  Rows(hid_t dataset, std::size_t first, std::size_t n_rows)
      : shape(extent(dataset)), start{first, 0}, count{n_rows, shape.size() == 2 ? shape[1] : 1},
        in_file(H5Dget_space(dataset), H5Sclose),
        in_memory(H5Screate_simple(static_cast<int>(shape.size()), count, nullptr), H5Sclose)
  {
    H5Sselect_hyperslab(in_file, H5S_SELECT_SET, start, nullptr, count, nullptr);
  }
};

/// Iteration callback: adds a name to the vector behind `out`.
template <typename Info>
herr_t collect(hid_t, const char *name, const Info *, void *out)
{
  static_cast<std::vector<std::string> *>(out)->emplace_back(name);
  return 0;
}
} // namespace

std::string Group::child(const std::string &name) const
{
  if (name == ".")
    return path_;
  assert(!name.empty() && name.find('/') == std::string::npos);
  return path_ == "/" ? "/" + name : path_ + "/" + name;
}

std::string Group::where() const { return file_->path.string() + ":" + path_; }
const std::filesystem::path &Group::file_path() const { return file_->path; }

bool Group::has(const std::string &name) const
{
  const Turn turn;
  assert(file_->id >= 0);
  return answer(*file_, child(name), H5Lexists(file_->id, child(name).c_str(), within_file()));
}

bool Group::has_attribute(const std::string &name, const std::string &item) const
{
  const Turn turn;
  return answer(*file_, child(item), H5Aexists(open_item(*file_, child(item)), name.c_str()));
}

std::vector<std::string> Group::names() const
{
  const Turn turn;
  std::vector<std::string> found;
  answer(*file_, path_,
         H5Literate_by_name(file_->id, path_.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect<H5L_info_t>, &found,
                            within_file()));
  return found;
}

std::vector<std::string> Group::attribute_names() const
{
  const Turn turn;
  std::vector<std::string> found;
  answer(*file_, path_,
         H5Aiterate2(open_item(*file_, path_), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect<H5A_info_t>, &found));
  return found;
}

Group Group::group(const std::string &name) const
{
  const Turn turn;
  constexpr const char *missing = "there is no such group";
  if (H5Iget_type(open_item(*file_, child(name), missing)) != H5I_GROUP)
    fail(*file_, child(name), missing);
  return {file_, child(name)};
}

Group Group::create_group(const std::string &name)
{
  const Turn turn;
  assert(file_->id >= 0 && file_->writing);
  const Handle made = checked(H5Gcreate2(file_->id, child(name).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                              H5Gclose, *file_, child(name), "creating the group failed (does it exist already?)");
  return {file_, child(name)};
}

Shape Group::shape(const std::string &name) const
{
  const Turn turn;
  return extent(open_stored(*file_, child(name)));
}

template <typename T>
std::vector<T> Group::read(const std::string &name) const
{
  const Turn turn;
  const Handle dataset = open_stored(*file_, child(name));
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  return read_values<T>(*file_, child(name), type, space, [id = hid_t(dataset)](hid_t memory, void *buffer) {
    return H5Dread(id, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
  });
}

template <typename T>
std::vector<T> Group::read(const std::string &name, const Shape &expected) const
{
  const Shape found = shape(name);
  if (found != expected)
    fail(*file_, child(name), fmt::format("its shape is {}, expected {}", found, expected));
  return read<T>(name);
}

std::vector<double> Group::rows(const std::string &name, std::size_t first, std::size_t n_rows) const
{
  const Turn turn;
  const Handle dataset = open_stored(*file_, child(name)), type(H5Dget_type(dataset), H5Tclose);
  if (extent(dataset).size() > 2)
    fail(*file_, child(name), "it is no series of rows");
  const Rows rows(dataset, first, n_rows);
  return read_values<double>(*file_, child(name), type, rows.in_memory, [&](hid_t memory, void *buffer) {
    return H5Dread(dataset, memory, rows.in_memory, rows.in_file, H5P_DEFAULT, buffer);
  });
}

template <typename T>
T Group::attribute(const std::string &name, const std::string &item) const
{
  const Turn turn;
  const std::string full = child(item) + "@" + name;
  const Handle owner = open_item(*file_, child(item));
  const Handle attribute =
      checked(H5Aopen(owner, name.c_str(), H5P_DEFAULT), H5Aclose, *file_, full, "there is no such attribute");
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != 1)
    fail(*file_, full, "it is not a single value");
  return read_values<T>(*file_, full, type, space,
                        [id = hid_t(attribute)](hid_t memory, void *buffer) { return H5Aread(id, memory, buffer); })[0];
}

void Group::set_attribute(const std::string &name, const std::variant<double, std::uint64_t, std::string> &value,
                          const std::string &item)
{
  const Turn turn;
  const std::string full = child(item) + "@" + name;
  const Handle owner = open_item(*file_, child(item)), space(H5Screate(H5S_SCALAR), H5Sclose);
  if (H5Aexists(owner, name.c_str()) > 0)
    H5Adelete(owner, name.c_str());
  const auto put = [&]<typename T>(const T &x) {
    const Handle attribute = checked(H5Acreate2(owner, name.c_str(), type_of<T>(), space, H5P_DEFAULT, H5P_DEFAULT),
                                     H5Aclose, *file_, full, "creating the attribute failed");
    const auto transfer = [&](hid_t type, const void *buffer) { return H5Awrite(attribute, type, buffer); };
    if (!write_values<T>({&x, 1}, transfer))
      fail(*file_, full, "writing failed");
  };
  std::visit(put, value);
}

template <typename T>
void Group::put(const std::string &name, std::span<const T> values, const std::string &unit, std::size_t n_columns)
{
  const Turn turn;
  assert(file_->id >= 0 && file_->writing && n_columns > 0 && values.size() % n_columns == 0);
  const hsize_t dims[2] = {values.size() / n_columns, n_columns};
  const Handle space(H5Screate_simple(n_columns == 1 ? 1 : 2, dims, nullptr), H5Sclose),
      layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const Handle dataset = create_dataset<T>(*file_, child(name), space, layout);
  const auto transfer = [id = hid_t(dataset)](hid_t type, const void *buffer) {
    return H5Dwrite(id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, buffer);
  };
  if (!values.empty() && !write_values<T>(values, transfer))
    fail(*file_, child(name), "writing failed");
  set_attribute("unit", unit, name);
}

void Group::create_series(const std::string &name, const std::string &unit, std::size_t n_columns,
                          std::size_t rows_per_chunk)
{
  const Turn turn;
  assert(file_->id >= 0 && file_->writing && n_columns > 0 && rows_per_chunk > 0);
  const hsize_t dims[2] = {0, n_columns}, limits[2] = {H5S_UNLIMITED, n_columns},
                chunk[2] = {rows_per_chunk, n_columns};
  const int rank = n_columns == 1 ? 1 : 2;
  const Handle space(H5Screate_simple(rank, dims, limits), H5Sclose), layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(layout, rank, chunk);
  const Handle made = create_dataset<double>(*file_, child(name), space, layout);
  file_->grows = true;
  set_attribute("unit", unit, name);
}

void Group::append(const std::string &name, std::span<const double> values)
{
  const Turn turn;
  const Handle dataset = open_dataset(*file_, child(name));
  const Shape before = extent(dataset);
  const std::size_t n_columns = before.size() == 2 ? before[1] : 1, n_rows = values.size() / n_columns;
  assert(values.size() % n_columns == 0);
  if (values.empty())
    return;
  file_->grows = true;
  resize(name, before[0] + n_rows);
  const Rows rows(dataset, before[0], n_rows);
  if (H5Dwrite(dataset, H5T_IEEE_F64LE, rows.in_memory, rows.in_file, H5P_DEFAULT, values.data()) < 0)
    fail(*file_, child(name), "writing failed");
}

void Group::resize(const std::string &name, std::size_t n_rows)
{
  const Turn turn;
  const Handle dataset = open_dataset(*file_, child(name));
  const Shape now = extent(dataset);
  const hsize_t target[2] = {n_rows, now.size() == 2 ? now[1] : 1};
  if (now.size() > 2 || H5Dset_extent(dataset, target) < 0)
    fail(*file_, child(name), "changing the number of rows failed (made by create_series?)");
}

#define ISOSTAT_INSTANTIATE(T) \
  template std::vector<T> Group::read<T>(const std::string &) const; \
  template std::vector<T> Group::read<T>(const std::string &, const Shape &) const; \
  template T Group::attribute<T>(const std::string &, const std::string &) const; \
  template void Group::put<T>(const std::string &, std::span<const T>, const std::string &, std::size_t);
ISOSTAT_INSTANTIATE(double)
ISOSTAT_INSTANTIATE(std::uint64_t)
ISOSTAT_INSTANTIATE(std::uint32_t)
ISOSTAT_INSTANTIATE(std::string)
#undef ISOSTAT_INSTANTIATE
} // namespace isostat::hdf5
